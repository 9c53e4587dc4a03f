#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/report/run_report.h"

namespace curvewright {

/// A picture that a report wants.
struct PictureWish {
    std::optional<Index> element;  ///< with its neighbours from near; none = the whole mesh
    bool is_result = false;        ///< the mesh as it became; else as it was
    int width = 0, height = 0;     ///< pixels
};
/// The whole mesh, the elements that were worst and those that are worst now: each before and after, in this order.
std::vector<PictureWish> picture_wishes(const RunReport& report);

/// The pictures of a report.
struct ReportPictures {
    std::vector<std::string> png;  ///< one per wish, or none at all
    std::string note;              ///< why there are none; "" otherwise
};
/// Has them drawn one after the other. Where that is not possible (draw throws Unsupported) there are none, with a
/// note.
ReportPictures draw_pictures(const RunReport& report, const std::function<std::string(const PictureWish&)>& draw,
                             const TaskContext& context = {});

}  // namespace curvewright
