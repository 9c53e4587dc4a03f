#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/session/action.h"

namespace curvewright {

/// A parameter of a method as a report tells it.
struct ReportParameter {
    using Value = std::variant<bool, int, double, std::string, std::vector<std::string>, std::vector<double>>;
    std::string name;
    Value value;
    std::string meaning;  ///< one phrase
};

/// "guaranteed", "signed-angle", "unsigned-angle": the names of the command line.
std::string method_name(const UntangleOptions& options);
/// "Guaranteed method" and the like, for people, and how it works, one sentence.
std::string method_title(const UntangleOptions& options);
/// How the method works, one sentence.
std::string method_description(const UntangleOptions& options);
/// All that the result depends on.
std::vector<ReportParameter> parameters_of(const UntangleOptions& options);

}  // namespace curvewright
