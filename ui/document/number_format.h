#pragma once

#include <QString>

namespace curvewright {

/// Three significant digits with a true minus sign ("−0.122", "0.0031", "1.00"); "–" for a value that is no number.
QString format_number(double value);
/// A component of a vector of this length: 0 if it is nothing but rounding.
QString format_component(double value, double length);
/// At most three significant digits: "0.9", "−0.25", "12".
QString short_number(double value);
/// An integer with thousands separators ("1,338").
QString format_count(long long value);
/// The number with 17 significant digits, for the clipboard.
QString exact_number(double value);

}  // namespace curvewright
