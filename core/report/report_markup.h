#pragma once

#include <string>
#include <string_view>

namespace curvewright {

/// Text for HTML and XML, attributes included: marks are escaped; bytes that are no UTF-8, and characters that XML does
/// not allow, become U+FFFD.
std::string escaped(std::string_view text);

/// Four significant digits with a true minus sign: "−0.1221", "1.000", "3.21×10⁻⁷"; "–" for what is no number.
std::string number_text(double value);
/// As few of the four digits as the number needs: "0.9", "60", "4×10⁶".
std::string short_number_text(double value);
/// With thousands separators: "1,338".
std::string count_text(long long value);
/// "0.0042 s", "12.3 s".
std::string seconds_text(double seconds);

/// RFC 4648, without line breaks.
std::string base64(std::string_view bytes);

}  // namespace curvewright
