#include "app/cli/render_view.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright::cli {
namespace {

/// Numbers between commas; empty if the text is something else.
template <class Number>
std::vector<Number> read_numbers(std::string_view text) {
    std::vector<Number> numbers;
    const char *at = text.data(), *const end = at + text.size();
    while (true) {
        Number number{};
        const auto [rest, error] = std::from_chars(at, end, number);
        if (error != std::errc()) return {};
        numbers.push_back(number);
        if (rest == end) return numbers;
        if (*rest != ',') return {};
        at = rest + 1;
    }
}

bool are_finite(const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

std::string parse_direction(const std::string& text, RenderView& view) {
    static const std::map<std::string, Eigen::RowVector3d> named = {
        {"iso", {1.0, -1.3, 0.85}},  {"front", {0.0, -1.0, 0.0}}, {"back", {0.0, 1.0, 0.0}},
        {"left", {-1.0, 0.0, 0.0}},  {"right", {1.0, 0.0, 0.0}},  {"top", {0.0, 0.0, 1.0}},
        {"bottom", {0.0, 0.0, -1.0}}};
    if (const auto found = named.find(text); found != named.end()) {
        view.to_eye = found->second;
        return {};
    }
    const std::vector<double> angles = read_numbers<double>(text);
    if (angles.size() != 2 || !are_finite(angles) || std::abs(angles[1]) > 90.0)
        return "expected iso, front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in degrees, as in -52,27";
    const double azimuth = angles[0] * std::numbers::pi / 180.0, elevation = angles[1] * std::numbers::pi / 180.0;
    view.to_eye = Eigen::RowVector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                     std::sin(elevation));
    return {};
}

std::string parse_zoom(const std::string& text, RenderView& view) {
    view.zoom = read_numbers<double>(text);
    if ((view.zoom.size() != 3 && view.zoom.size() != 4) || !are_finite(view.zoom) || !(view.zoom.back() > 0.0))
        return "expected X,Y,RADIUS or X,Y,Z,RADIUS, the radius positive";
    return {};
}

std::string parse_choice(const std::string& text, std::optional<ElementChoice>& choice) {
    constexpr const char* expected = "expected tangled, worst, worst:N or element:TAG,TAG...";
    if (text == "tangled" || text == "worst") {
        choice = {text == "worst" ? ElementChoice::Kind::worst : ElementChoice::Kind::tangled, 1, {}};
        return {};
    }
    const std::size_t colon = text.find(':');
    if (colon == text.npos) return expected;
    const std::vector<std::int64_t> numbers = read_numbers<std::int64_t>(std::string_view(text).substr(colon + 1));
    const std::string kind = text.substr(0, colon);
    if (kind == "worst" && numbers.size() == 1 && numbers[0] > 0)
        choice = {ElementChoice::Kind::worst, static_cast<std::size_t>(numbers[0]), {}};
    else if (kind == "element" && !numbers.empty())
        choice = {ElementChoice::Kind::tags, 0, numbers};
    else
        return expected;
    return {};
}

}  // namespace

void add_view_options(CLI::App& command, RenderView& view) {
    command
        .add_option("--view",
                    "3D: from where: iso (default), front, back, left, right, top, bottom, or angles in degrees")
        ->type_name("SIDE|AZIMUTH,ELEVATION")
        ->check([&view](const std::string& text) { return parse_direction(text, view); });
    CLI::Option* zoom = command.add_option("--zoom", "From near: a circle or ball with a little room around it")
                            ->type_name("X,Y[,Z],R")
                            ->check([&view](const std::string& text) { return parse_zoom(text, view); });
    CLI::Option* focus =
        command
            .add_option("--focus", "From near: all elements that are not valid, the worst one or N, or those with tags")
            ->type_name("tangled|worst[:N]|element:TAG,...")
            ->check([&view](const std::string& text) { return parse_choice(text, view.focus); });
    focus->excludes(zoom);
    command
        .add_option("--margin", view.margin, "Room around what --focus shows, as a multiple of its radius (default 1)")
        ->check(CLI::Range(0.0, 1000.0))
        ->needs(focus);
    command.add_option("--outline", "Elements to outline, named as for --focus")
        ->type_name("ELEMENTS")
        ->check([&view](const std::string& text) { return parse_choice(text, view.outline); });
}

std::vector<Index> choose_elements(const ElementChoice& choice, const CurvedMesh& mesh, const QualityReport* quality) {
    std::vector<Index> elements;
    if (choice.kind == ElementChoice::Kind::tags) {
        for (const std::int64_t tag : choice.tags) {
            const std::optional<Index> element = mesh.topology().find_element(ElementTag{tag});
            if (!element) throw InvalidInput(fmt::format("The mesh has no element {}.", tag));
            elements.push_back(*element);
        }
        return elements;
    }
    if (!quality) throw InvalidInput("The worst elements cannot be told: the quality of this mesh cannot be assessed.");
    if (choice.kind == ElementChoice::Kind::worst) {
        elements = quality->worst(choice.count);
        if (elements.empty()) throw InvalidInput("The mesh has no elements.");
        return elements;
    }
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        if (const Validity validity = quality->elements[static_cast<std::size_t>(element)].validity;
            validity == Validity::invalid || validity == Validity::undecided)
            elements.push_back(element);
    if (elements.empty()) throw InvalidInput("No element is tangled; \"worst\" names the worst one.");
    return elements;
}

std::optional<ShownBall> find_shown_ball(const RenderView& view, const CurvedMesh& mesh, const QualityReport* quality) {
    if (!view.is_near()) return std::nullopt;
    ShownBall ball;
    if (!view.zoom.empty()) {
        const bool is_solid = mesh.topology().dimension() == 3;
        if (is_solid && view.zoom.size() != 4)
            throw InvalidInput("--zoom of a solid needs four numbers: X,Y,Z,RADIUS.");
        const double z = view.zoom.size() == 4 ? view.zoom[2] : bounding_box(mesh)(0, 2);
        ball.center = {view.zoom[0], view.zoom[1], z};
        ball.radius = view.zoom.back();
        return ball;
    }
    ball.elements = choose_elements(*view.focus, mesh, quality);
    Eigen::RowVector3d low = Eigen::RowVector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Index element : ball.elements) {
        const Eigen::MatrixX3d x = mesh.element_coordinates(element);
        low = low.cwiseMin(x.colwise().minCoeff());
        high = high.cwiseMax(x.colwise().maxCoeff());
    }
    ball.center = 0.5 * (low + high);
    for (const Index element : ball.elements) {
        const Eigen::MatrixX3d x = mesh.element_coordinates(element);
        ball.radius = std::max(ball.radius, (x.rowwise() - ball.center).rowwise().norm().maxCoeff());
    }
    ball.radius *= 1.0 + view.margin;
    return ball;
}

double magnification(const ShownBall& ball, const CurvedMesh& mesh) {
    const auto box = bounding_box(mesh);
    const double half = 0.5 * (box.row(1) - box.row(0)).norm();
    return ball.radius > 0.0 ? std::clamp(half / ball.radius, 1.0, 1e6) : 1.0;
}

void apply_view(const RenderView& view, const std::optional<ShownBall>& ball, int width, int height, MeshScene& scene) {
    if (view.to_eye) scene.look_from(*view.to_eye);
    if (!ball) return;
    // Upright pictures, and what the legend covers, leave it less room in width.
    const double free_width = std::max(0.1 * width, width - scene.legend_width());
    scene.focus_ball(ball->center, ball->radius * std::max(1.0, height / free_width));
}

Json ball_json(const ShownBall& ball, const CurvedMesh& mesh) {
    Json tags = Json::array();
    for (const Index element : ball.elements) tags.push_back(mesh.topology().element_tag(element).value);
    return {{"center", {ball.center[0], ball.center[1], ball.center[2]}}, {"radius", ball.radius}, {"elements", tags}};
}

}  // namespace curvewright::cli
