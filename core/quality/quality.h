#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/orientation_signs.h"

namespace curvewright {

/// What is proved about the sign of an element's Jacobian determinant J.
enum class Validity {
    valid,         ///< J > 0 everywhere
    invalid,       ///< J < 0 somewhere ("tangled")
    undecided,     ///< neither could be proved: the subdivision budget ran out, or min J is zero up to rounding
    not_assessed,  ///< nothing was looked at: pyramids, whose shape functions are rational
};
/// "valid", "invalid", "undecided", "not assessed".
const char* to_string(Validity validity);

/// Sign of J that the parts of the mesh have (see OrientationSigns), reversed elements set aside.
enum class Orientation {
    positive,  ///< J > 0 expected
    negative,  ///< all parts are numbered the other way round: J < 0 expected. Not tangling; see flip_orientation.
    mixed,     ///< some parts are positive, some negative; each is judged by its own sign
};
/// "positive", "negative", "mixed".
const char* to_string(Orientation orientation);

/// How closely elements are judged.
struct QualityOptions {
    /// The bounds of min J and of max J are refined until they are this close, relative to max |J| of the element.
    double tolerance = 2.5e-4;
    /// Bisections of the reference element per bound before the element is called undecided.
    int max_subdivisions = 4000;
    /// Signs of J of valid elements; not given: those of the mesh. For judging what became of a mesh, give those of the
    /// original (QualityReport::orientation_sign): a mesh that was turned inside out is not valid.
    std::optional<OrientationSigns> orientation_sign;
};

/// Certified quality of one element. J is that of the mesh's orientation: positive in a valid element, reversed or not.
struct ElementQuality {
    /// min J / |max J| from values that J attains; 1 for a straight-sided simplex, parallelogram or parallelepiped, <=
    /// 0 for a tangled element. NaN if it was not assessed.
    double scaled_jacobian = 1.0;
    /// Proved bounds: min_lower <= min J <= min_upper, max_lower <= max J <= max_upper (rounding included).
    double min_lower = 0.0, min_upper = 0.0, max_lower = 0.0, max_upper = 0.0;
    Validity validity = Validity::undecided;
    /// Numbered against the majority of its part of the mesh, see Winding. Says nothing about its validity.
    bool is_reversed = false;
    /// Reference coordinates where J attains min_upper.
    std::array<double, 3> worst_point{};
};

/// The quality of a mesh in a few numbers.
struct QualitySummary {
    /// Of the scaled Jacobian, over the assessed elements; 0 if there are none.
    double min = 0.0, mean = 0.0, max = 0.0;
    Index valid = 0, invalid = 0, undecided = 0;
    Index not_assessed = 0;
    Index reversed = 0;  ///< of all of these, those that are numbered against their neighbours
    Index assessed() const { return valid + invalid + undecided; }
    Index elements() const { return assessed() + not_assessed; }
};

/// The certified quality of a mesh.
struct QualityReport {
    std::vector<ElementQuality> elements;  ///< one per element, in the order of the mesh
    QualitySummary summary;
    Orientation orientation = Orientation::positive;  ///< of the straight-sided elements
    OrientationSigns orientation_sign;                ///< what J was multiplied with

    /// Elements by ascending scaled Jacobian (ties by index), at most `count`; those that were not assessed last.
    std::vector<Index> worst(std::size_t count) const;
};

/// Throws Unsupported unless the mesh consists of triangles and quadrilaterals in a plane of constant z, or of elements
/// of dimension 3. Pyramids are told as not assessed.
void require_assessable(const CurvedMesh& mesh);

/// Orientation of a mesh. Throws like require_assessable.
Orientation find_orientation(const CurvedMesh& mesh);
/// Orientation that has these signs.
Orientation orientation_of(const OrientationSigns& signs);

/// The same elements numbered the other way round (J changes its sign). Throws like require_assessable.
CurvedMesh flip_orientation(const CurvedMesh& mesh);

/// What reorient() did.
struct Reorientation {
    CurvedMesh mesh;
    Index reversed = 0;    ///< elements that ran against their neighbours
    Index renumbered = 0;  ///< elements that are numbered the other way round now
};
/// The same mesh with all elements numbered so that J > 0 is expected (surfaces in space: so that none is reversed):
/// reversed elements and those of negative parts are renumbered, but not those that are both. Tags, entities, groups
/// and the order of everything stay, and so do cells of lower dimension.
Reorientation reorient(const CurvedMesh& mesh);

/// Certified scaled Jacobian of every element: J in Bernstein-Bézier form, adaptive subdivision (Johnen, Remacle,
/// Geuzaine, "Geometrical validity of curvilinear finite elements", J. Comput. Phys. 233, 2013). Multi-threaded.
/// Throws Unsupported (see require_assessable) and Cancelled.
QualityReport assess_quality(const CurvedMesh& mesh, const QualityOptions& options = {},
                             const TaskContext& context = {});

/// Certified qualities of some elements at the given positions (nodes × 3). options: orientation_sign must be given.
/// Multi-threaded. Throws Cancelled.
std::vector<ElementQuality> certify_elements(const MeshTopology& topology, std::span<const Index> elements,
                                             const Coordinates& positions, const QualityOptions& options,
                                             const TaskContext& context = {});

/// Brings a report up to date after some nodes have moved: certifies the given elements at their new positions and
/// sums up anew. The orientation stays as reported, and J is multiplied with the report's sign whatever the options
/// say. elements: those that have a node that moved, at least. positions: nodes × 3; 2D meshes keep their z.
/// Multi-threaded. Throws InvalidInput for a report or positions of another mesh, and Cancelled; the report is then to
/// be thrown away.
void update_quality(QualityReport& report, const MeshTopology& topology, const Coordinates& positions,
                    std::span<const Index> elements, const QualityOptions& options = {},
                    const TaskContext& context = {});

/// Equal bins over [lower, upper]; values outside count in the first and last bin.
struct Histogram {
    double lower = 0.0, upper = 1.0;
    std::vector<Index> counts;
    double bin_width() const { return (upper - lower) / static_cast<double>(counts.size()); }
    int bin_of(double value) const;
};
/// Histogram of the scaled Jacobian of all elements that were assessed.
Histogram make_histogram(const QualityReport& report, double lower, double upper, int bins);

}  // namespace curvewright
