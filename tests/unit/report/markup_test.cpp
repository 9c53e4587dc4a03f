#include "core/report/report_markup.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/report/report_charts.h"

namespace curvewright {
namespace {

TEST(ReportMarkup, EscapesWhatXmlReadsAsMarks) {
    EXPECT_EQ(escaped("<b a='1' c=\"2\">&amp;</b>"), "&lt;b a=&#39;1&#39; c=&quot;2&quot;&gt;&amp;amp;&lt;/b&gt;");
    EXPECT_EQ(escaped("Flügel – 翼 \xF0\x9F\x99\x82"), "Flügel – 翼 \xF0\x9F\x99\x82");
}

TEST(ReportMarkup, ReplacesWhatIsNoCharacter) {
    const std::string bad = "\xEF\xBF\xBD";
    EXPECT_EQ(escaped(std::string_view("a\0b\x01\x1f\t\n", 7)), "a" + bad + "b" + bad + bad + "\t\n");
    EXPECT_EQ(escaped("\xff\xfe"), bad + bad);                      // never in UTF-8
    EXPECT_EQ(escaped("\xc3"), bad);                                // breaks off
    EXPECT_EQ(escaped("\xc0\xaf"), bad + bad);                      // overlong
    EXPECT_EQ(escaped("\xed\xa0\x80"), bad + bad + bad);            // a surrogate
    EXPECT_EQ(escaped("\xef\xbf\xbf"), bad + bad + bad);            // U+FFFF
    EXPECT_EQ(escaped("\xf4\x90\x80\x80"), bad + bad + bad + bad);  // beyond U+10FFFF
}

TEST(ReportMarkup, NumbersHaveFourDigitsAndATrueMinus) {
    EXPECT_EQ(number_text(0.0), "0");
    EXPECT_EQ(number_text(1.0), "1.000");
    EXPECT_EQ(number_text(-0.12204), "−0.1220");
    EXPECT_EQ(number_text(1346.4), "1346");
    EXPECT_EQ(number_text(3.21e-7), "3.210×10⁻⁷");
    EXPECT_EQ(number_text(-4.5e12), "−4.5×10¹²");
    EXPECT_EQ(number_text(std::nan("")), "–");
    EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "–");
    EXPECT_EQ(short_number_text(0.9), "0.9");
    EXPECT_EQ(short_number_text(4e6), "4×10⁶");
    EXPECT_EQ(short_number_text(1e-20), "1×10⁻²⁰");
    EXPECT_EQ(count_text(0), "0");
    EXPECT_EQ(count_text(999), "999");
    EXPECT_EQ(count_text(1338), "1,338");
    EXPECT_EQ(count_text(-1234567), "−1,234,567");
    EXPECT_EQ(seconds_text(0.0001), "less than 0.001 s");
    EXPECT_EQ(seconds_text(12.34), "12.3 s");
}

TEST(ReportMarkup, Base64) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\x00\x80"), "/w==");  // up to the zero
    EXPECT_EQ(base64(std::string_view("\xff\x00\x80", 3)), "/wCA");
}

std::size_t count_of(const std::string& text, const std::string& what) {
    std::size_t count = 0;
    for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++count;
    return count;
}

TEST(ReportCharts, DrawsWhatThereIs) {
    EXPECT_EQ(chart_svg({}), "");
    EXPECT_EQ(chart_svg({"t", "x", {{{{0, -1}, {1, 0}}, true}}, true, false, false}), "");  // no logarithms
    EXPECT_EQ(chart_svg({"t", "x", {{{{0, std::nan("")}}, true}}, false, false, false}), "");
    const std::string point = chart_svg({"t", "x", {{{{3, 0.5}}, true}}, false, false, true});
    EXPECT_EQ(count_of(point, "<circle"), 1u);
    EXPECT_EQ(count_of(point, "<polyline"), 0u);
    const std::string lines =
        chart_svg({"a<b", "x", {{{{0, -0.5}, {1, 0.5}}, true}, {{{0, 0.1}, {1, 0.2}}, false}}, false, false, true});
    EXPECT_EQ(count_of(lines, "<polyline"), 2u);
    EXPECT_EQ(count_of(lines, "stroke-dasharray"), 1u);  // the line of 0
    EXPECT_EQ(count_of(lines, "a&lt;b"), 2u);
    // The accent is drawn last.
    EXPECT_GT(lines.rfind("#1c62c4"), lines.rfind("#a9afb7"));
    for (const double value : {1e-300, 1e300, -1e300, 0.0})
        EXPECT_EQ(count_of(chart_svg({"t", "x", {{{{0, value}, {1, value}}, true}}, false, false, false}), "nan"), 0u);
}

TEST(ReportCharts, BarsAreAsHighAsTheirCounts) {
    const ReportColors colors{[](double) { return std::string("#112233"); }, "#d6006c", "#7a68a8"};
    ReportHistogram histogram;
    histogram.valid.resize(ReportHistogram::bins);
    histogram.undecided.resize(ReportHistogram::bins);
    histogram.valid[24] = 9;
    histogram.undecided[3] = 9;
    histogram.tangled = 9;
    const std::string svg = histogram_svg(histogram, 9, colors, "title");
    EXPECT_EQ(count_of(svg, "height='146.00'"), 3u) << svg;
    EXPECT_EQ(count_of(svg, "fill='#112233'"), 1u);
    EXPECT_EQ(count_of(svg, "fill='#7a68a8'"), 1u);
    EXPECT_EQ(count_of(svg, "fill='url(#hatch)'"), 1u);
    EXPECT_EQ(count_of(histogram_svg(histogram, 99, colors, "title"), "height='73.00'"), 3u);
}

TEST(ReportCharts, HistogramsStandBesideOneAnotherOnOneScale) {
    const ReportColors colors{[](double) { return std::string("#112233"); }, "#d6006c", "#7a68a8"};
    HistogramPanel low{"first & only", {}, {}};
    low.histogram.valid.resize(ReportHistogram::bins);
    low.histogram.undecided.resize(ReportHistogram::bins);
    low.histogram.valid[3] = 9;
    HistogramPanel high = low;
    high.histogram.valid[3] = 99;
    const std::string svg = histograms_document({low, high, low}, colors);
    EXPECT_EQ(count_of(svg, "height='73.00'"), 2u) << svg;  // half as high as 99, whose logarithm is twice that of 9
    EXPECT_EQ(count_of(svg, "height='146.00'"), 1u);
    EXPECT_EQ(count_of(svg, "<svg x='12'"), 2u);  // two in a row
    EXPECT_EQ(count_of(svg, "first &amp; only</text>"), 3u);
    EXPECT_EQ(count_of(svg, "<pattern"), 1u);
    EXPECT_EQ(count_of(histograms_document({low}, colors), "height='146.00'"), 1u);
}

}  // namespace
}  // namespace curvewright
