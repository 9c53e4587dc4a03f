#include "core/io/deformation_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_depth.h"
#include "core/io/atomic_file.h"
#include "core/io/mesh_io.h"

namespace curvewright {
namespace {

using nlohmann::json;

constexpr const char* known_types = "translate, rotate, scale, shear, expression, snap_to";
constexpr const char* known_shapes = "circle, sphere, cylinder, revolution, ellipse, naca0012, naca";

/// What a JSON value is, for messages.
std::string kind_of(const json& value) {
    if (value.is_null()) return "null";
    if (value.is_string()) return fmt::format("\"{}\"", value.get<std::string>().substr(0, 40));
    if (value.is_object()) return "an object";
    if (value.is_array()) return fmt::format("a list of {}", value.size());
    return value.dump();
}

/// One operation of the file. All complaints name the file, the operation (counted from 1), its group and its type.
class OperationReader {
  public:
    OperationReader(const json& object, std::string file, std::size_t number)
        : object_(object), where_(fmt::format("operation {}", number)), file_(std::move(file)) {}

    Operation read() {
        if (!object_.is_object())
            fail(fmt::format("an object {{\"group\": ..., \"type\": ...}} was expected, not {}.", kind_of(object_)));
        Operation operation;
        operation.group = text("group");
        if (operation.group.empty()) fail("\"group\" must not be empty.");
        where_ += fmt::format(" (group \"{}\")", operation.group);
        operation.kind = read_kind(text("type"));
        return operation;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InvalidInput(file_, 0, where_ + ": " + message); }

    OperationKind read_kind(const std::string& type) {
        where_ += " " + type;
        if (type == "translate") return Translate{vector("vector")};
        if (type == "rotate")
            return Rotate{vector("center"), number("angle_deg"), has("axis") ? direction("axis") : Vector3{0, 0, 1}};
        if (type == "scale") return Scale{vector("center"), vector("factors")};
        if (type == "shear")
            return Shear{letter("axis"), letter("along"), number("factor"), has("origin") ? number("origin") : 0.0};
        if (type == "expression") return read_expression();
        if (type == "snap_to") return read_snap(text("shape"));
        fail(fmt::format("unknown type \"{}\"; one of {} was expected.", type, known_types));
    }
    Expression read_expression() {
        Expression expression;
        const std::array<const char*, 3> names = {"x", "y", "z"};
        for (std::size_t d = 0; d < 3; ++d)
            if (has(names[d])) expression.components[d] = text(names[d]);
        const auto& all = expression.components;
        if (std::none_of(all.begin(), all.end(), [](const auto& component) { return component.has_value(); }))
            fail("at least one of \"x\", \"y\", \"z\" was expected.");
        return expression;
    }
    OperationKind read_snap(const std::string& shape) {
        where_ += " " + shape;
        if (shape == "circle") return SnapToCircle{vector("center"), positive("radius")};
        if (shape == "sphere") return SnapToSphere{vector("center"), positive("radius")};
        if (shape == "cylinder")
            return SnapToCylinder{vector("center"), has("axis") ? direction("axis") : Vector3{0, 0, 1},
                                  positive("radius")};
        if (shape == "revolution") return SnapToRevolution{has("axis") ? letter("axis") : 2, profile()};
        if (shape == "ellipse") {
            const auto axes = numbers("semi_axes", 2);
            if (!(axes[0] > 0.0 && axes[1] > 0.0)) fail("\"semi_axes\" must be two positive numbers.");
            return SnapToEllipse{vector("center"), axes[0], axes[1]};
        }
        if (shape.starts_with("naca")) return SnapToNaca{vector("leading_edge"), positive("chord"), thickness(shape)};
        fail(fmt::format("unknown shape \"{}\"; one of {} was expected.", shape, known_shapes));
    }
    /// "naca0012", or "naca" with "digits": "0012" or "thickness": 0.12.
    double thickness(const std::string& shape) const {
        std::string digits = shape.substr(4);
        if (digits.empty() && has("digits")) digits = text("digits");
        if (digits.empty()) {
            const double value = has("thickness") ? positive("thickness") : 0.12;
            if (value >= 1.0) fail(fmt::format("\"thickness\" is a fraction of the chord below 1, not {}.", value));
            return value;
        }
        int percent = 0;
        const char* end = digits.data() + digits.size();
        const bool is_four = digits.size() == 4 &&
                             std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
        if (is_four) std::from_chars(digits.data(), end, percent);
        if (percent < 1 || percent > 99)
            fail(fmt::format(
                "\"{}\" is no symmetric four-digit NACA profile; 00 and the thickness in percent (\"0012\") "
                "was expected.",
                digits));
        return percent / 100.0;
    }
    std::vector<std::array<double, 2>> profile() const {
        const json& list = at("profile");
        if (!list.is_array() || list.size() < 2)
            fail(fmt::format("\"profile\" must be a list of at least two pairs [height, radius], not {}.",
                             kind_of(list)));
        std::vector<std::array<double, 2>> points;
        for (const json& pair : list) {
            if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number())
                fail(fmt::format("point {} of \"profile\" must be a pair of numbers [height, radius].",
                                 points.size() + 1));
            points.push_back({pair[0].get<double>(), pair[1].get<double>()});
            const std::size_t count = points.size();
            if (points.back()[1] < 0.0)
                fail(fmt::format("point {} of \"profile\" has the negative radius {}.", count, points.back()[1]));
            if (count > 1 && !(points[count - 2][0] < points[count - 1][0]))
                fail(fmt::format("the heights of \"profile\" must ascend; those of points {} and {} are {} and {}.",
                                 count - 1, count, points[count - 2][0], points[count - 1][0]));
        }
        return points;
    }

    bool has(const char* key) const { return object_.contains(key); }
    const json& at(const char* key) const {
        if (!has(key)) fail(fmt::format("\"{}\" is missing.", key));
        return object_.at(key);
    }
    std::string text(const char* key) const {
        const json& value = at(key);
        if (!value.is_string()) fail(fmt::format("\"{}\" must be a string, not {}.", key, kind_of(value)));
        return value.get<std::string>();
    }
    double number(const char* key) const {
        const json& value = at(key);
        if (!value.is_number()) fail(fmt::format("\"{}\" must be a number, not {}.", key, kind_of(value)));
        return value.get<double>();
    }
    double positive(const char* key) const {
        const double value = number(key);
        if (!(value > 0.0)) fail(fmt::format("\"{}\" must be positive, not {}.", key, value));
        return value;
    }
    std::vector<double> numbers(const char* key, std::size_t count) const {
        const json& list = at(key);
        const bool is_list = list.is_array() && list.size() == count &&
                             std::all_of(list.begin(), list.end(), [](const json& one) { return one.is_number(); });
        if (!is_list) fail(fmt::format("\"{}\" must be a list of {} numbers, not {}.", key, count, list.dump()));
        return list.get<std::vector<double>>();
    }
    Vector3 vector(const char* key) const {
        const auto list = numbers(key, 3);
        return {list[0], list[1], list[2]};
    }
    int letter(const char* key) const {
        const std::string value = text(key);
        if (value == "x" || value == "y" || value == "z") return value[0] - 'x';
        fail(fmt::format("\"{}\" must be \"x\", \"y\" or \"z\", not \"{}\".", key, value));
    }
    /// A unit vector, from a letter or a vector of any length but zero.
    Vector3 direction(const char* key) const {
        Vector3 result{};
        if (at(key).is_string()) {
            result[static_cast<std::size_t>(letter(key))] = 1.0;
            return result;
        }
        result = vector(key);
        const double length = std::hypot(result[0], result[1], result[2]);
        if (!(length > 0.0)) fail(fmt::format("\"{}\" must not be the zero vector.", key));
        for (double& component : result) component /= length;
        return result;
    }

    const json& object_;
    std::string where_;
    std::string file_;
};

long line_of(const std::string& text, std::size_t byte) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
    return 1 + std::count(text.begin(), end, '\n');
}

OperationList read_operations(const std::string& text, const std::string& file) {
    if (is_json_too_deep(text))
        throw InvalidInput(file, 0, fmt::format("lists stand in each other more than {} deep.", deepest_json));
    json document;
    try {
        document = json::parse(text);
    } catch (const json::parse_error& error) {
        // nlohmann's text: "[json.exception.parse_error.101] parse error at line 1, column 2: what is wrong"
        const std::string message = error.what();
        const std::size_t colon = message.find(": ");
        throw InvalidInput(
            file, line_of(text, error.byte > 0 ? error.byte - 1 : 0),
            fmt::format("this is no valid JSON ({}).", colon == message.npos ? message : message.substr(colon + 2)));
    } catch (const json::exception& error) {
        throw InvalidInput(file, 0, fmt::format("this is no valid JSON ({}).", error.what()));
    }
    if (!document.is_object() || !document.contains("operations"))
        throw InvalidInput(file, 0, "an object with a list \"operations\" was expected.");
    const json& list = document.at("operations");
    if (!list.is_array())
        throw InvalidInput(file, 0, fmt::format("\"operations\" must be a list, not {}.", kind_of(list)));
    OperationList result;
    for (std::size_t i = 0; i < list.size(); ++i)
        result.operations.push_back(OperationReader(list[i], file, i + 1).read());
    return result;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    return text;
}

template <class T>
bool parse(std::string_view text, T& value) {
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(static_cast<double>(value));
}

NodeTable read_table(std::string_view text, const std::string& file) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    NodeTable table;
    std::unordered_set<std::int64_t> seen;
    bool has_header = false;
    for (long line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view row = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (row.empty()) continue;
        std::vector<std::string_view> fields;
        for (std::size_t begin = 0; begin <= row.size();) {
            const std::size_t comma = std::min(row.find(',', begin), row.size());
            fields.push_back(trimmed(row.substr(begin, comma - begin)));
            begin = comma + 1;
        }
        if (!has_header) {
            if (fields != std::vector<std::string_view>{"tag", "x", "y", "z"})
                throw InvalidInput(file, line, "the header \"tag,x,y,z\" was expected.");
            has_header = true;
            continue;
        }
        NodeTable::Row entry;
        if (fields.size() != 4)
            throw InvalidInput(file, line, fmt::format("4 columns (tag,x,y,z) were expected, not {}.", fields.size()));
        if (!parse(fields[0], entry.tag.value))
            throw InvalidInput(file, line,
                               fmt::format("\"{}\" stands where a node tag was expected.", fields[0].substr(0, 40)));
        for (std::size_t d = 0; d < 3; ++d)
            if (!parse(fields[d + 1], entry.position[d]))
                throw InvalidInput(file, line,
                                   fmt::format("\"{}\" stands where a coordinate (a finite number) was "
                                               "expected.",
                                               fields[d + 1].substr(0, 40)));
        if (!seen.insert(entry.tag.value).second)
            throw InvalidInput(file, line, fmt::format("node {} occurs twice.", entry.tag.value));
        table.rows.push_back(entry);
    }
    if (!has_header) throw InvalidInput(file, 0, "the file is empty; the header \"tag,x,y,z\" was expected.");
    if (table.rows.empty()) throw InvalidInput(file, 0, "the table holds no nodes.");
    return table;
}

NodeTable table_of_mesh(const CurvedMesh& mesh) {
    NodeTable table;
    table.is_mesh = true;
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const auto x = mesh.coordinates().row(node);
        table.rows.push_back({mesh.topology().node_tag(node), {x(0), x(1), x(2)}});
    }
    return table;
}

}  // namespace

Deformation parse_deformation(const std::string& text, const std::string& file, bool is_table) {
    if (is_table) return {read_table(text, file), file};
    return {read_operations(text, file), file};
}

Deformation read_deformation(const std::filesystem::path& file, const TaskContext& context) {
    context.check();
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });
    if (suffix == ".json" || suffix == ".csv")
        return parse_deformation(read_text_file(file), file.string(), suffix == ".csv");
    if (!format_of_suffix(file)) {
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored)) read_text_file(file);  // tells what is wrong with it
        throw InvalidInput(file.string(), 0,
                           fmt::format("\"{}\" is no suffix of a deformation; .json (operations), .csv (node table), "
                                       ".msh, .msh.gz, .vtu or .vtk (a mesh) was expected.",
                                       suffix));
    }
    return {table_of_mesh(read_mesh(file, context).mesh), file.string()};
}

}  // namespace curvewright
