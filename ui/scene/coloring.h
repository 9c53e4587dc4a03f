#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/mesh/field_array.h"
#include "core/quality/quality.h"
#include "ui/palette/color_map.h"

namespace curvewright {

class PlaneCut;
class SurfaceActor;
class SurfaceParts;
class Tessellation;

/// What the colours of the surface say.
struct Coloring {
    enum class Source {
        scaled_jacobian,
        plain,           ///< one colour
        distance_moved,  ///< of every point from where it was in `reference`; follows every motion
        array,           ///< numbers on nodes or elements
    };
    Source source = Source::scaled_jacobian;
    ColorMap map = ColorMap::warm;
    bool is_reversed = false;
    /// Ends of the range; not given: 0 and 1 of the scaled Jacobian, 0 and the largest of distances, those of the data
    /// of arrays.
    std::optional<double> lower, upper;
    /// Two lines over the legend; empty: those of the scaled Jacobian.
    std::string title, detail;
    std::shared_ptr<const FieldArray> array;
    bool is_of_one_state = false;  ///< the array was computed of the positions that are shown
    int component = -1;            ///< of an array: from 0; -1 = the length of the vectors
    std::shared_ptr<const Coordinates> reference;
};

/// Gives a surface the colours of a Coloring. Numbers on nodes are interpolated by the shape functions of the elements
/// and looked up in the map pixel by pixel.
class SurfacePainter {
  public:
    void set_coloring(const Coloring& coloring) { coloring_ = coloring; }
    const Coloring& coloring() const { return coloring_; }
    /// Numbers on nodes: elements above order 1 are to be cut finely even if they are straight.
    bool is_on_nodes() const;
    /// Whether a motion changes the colours by itself.
    bool follows_motion() const { return coloring_.source == Coloring::Source::distance_moved; }

    /// The scale and whether there are numbers, as paint() finds them.
    void find_scale(const CurvedMesh& mesh);
    /// quality: null = there is no report. An array that does not fit the mesh has no values.
    void paint(SurfaceParts& surface, const Tessellation& tessellation, const CurvedMesh& mesh,
               const QualityReport* quality);
    /// Gives the section of the mesh that was painted last the same colours.
    void paint_section(SurfaceActor& surface, const PlaneCut& section) const;
    /// As painted last: with the range that is shown.
    const ColorScale& scale() const { return scale_; }
    /// As painted last: whether there are numbers at all, and whether some are missing.
    bool has_values() const { return has_values_; }
    bool has_missing() const { return has_missing_; }

  private:
    void paint_array(SurfaceParts& surface, const Tessellation& tessellation);
    void fit(const std::vector<double>& values);
    void paint_elements(SurfaceParts& surface, const Tessellation& tessellation, std::function<Color(Index)> color_of);
    void paint_nodes(SurfaceParts& surface, const Tessellation& tessellation, std::vector<double> values,
                     int components, int component);

    Coloring coloring_;
    ColorScale scale_;
    bool has_values_ = false, has_missing_ = false;
    // As painted last: a colour per element, or numbers on nodes.
    std::function<Color(Index element)> color_of_;
    std::vector<double> nodal_;  ///< nodes × components; empty: elements have colours
    int components_ = 1, component_ = -1;
};

}  // namespace curvewright
