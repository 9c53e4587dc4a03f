#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/image_compare.h"
#include "tests/scene/scene_meshes.h"
#include "ui/scene/offscreen.h"

namespace curvewright {
namespace {

constexpr int width = 400, height = 300;

std::filesystem::path output(const std::string& name) {
    return temporary_picture(name);
}

/// Draws the scene and holds it against tests/scene/baselines/NAME.png. A missing baseline fails; with
/// CURVEWRIGHT_UPDATE_BASELINES=1 it is written instead (look at it before you keep it).
void check_against_baseline(MeshScene& scene, const std::string& name) {
    const std::filesystem::path baseline = std::filesystem::path(CURVEWRIGHT_BASELINES) / (name + ".png");
    const char* update = std::getenv("CURVEWRIGHT_UPDATE_BASELINES");
    if (update && std::string(update) == "1") {
        render_png(scene, width, height, baseline);
        return;
    }
    ASSERT_TRUE(std::filesystem::exists(baseline)) << baseline << " is missing";
    render_png(scene, width, height, output(name));
    const ImageDifference difference = compare(read_image(output(name)), read_image(baseline));
    EXPECT_TRUE(is_same(difference)) << output(name) << " differs from " << baseline << ": mean " << difference.mean
                                     << ", " << 100.0 * difference.far_pixels << " % of the pixels";
}

TEST(Images, RingWithATangledElement) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element}, {25});
    MeshScene scene;
    scene.set_mesh(&mesh, &report);
    check_against_baseline(scene, "ring");
}

TEST(Images, RingWithAFieldOnItsNodes) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element});
    auto field = std::make_shared<FieldArray>();
    for (Eigen::Index i = 0; i < mesh.coordinates().rows(); ++i)
        field->values.push_back(40.0 * mesh.coordinates()(i, 0) * mesh.coordinates()(i, 1));
    field->values[static_cast<std::size_t>(mesh.topology().element_nodes(20)[9])] = std::nan("");
    Coloring coloring;
    coloring.source = Coloring::Source::array;
    coloring.map = ColorMap::balance;
    coloring.array = field;
    coloring.title = "A name that is long";
    coloring.detail = "nodes";
    MeshScene scene;
    scene.set_coloring(coloring);
    scene.set_mesh(&mesh, &report);
    check_against_baseline(scene, "ring_field");
}

TEST(Images, RingWithNodesAndHighlightOnDark) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {});
    MeshScene scene;
    SceneOptions options;
    options.show_nodes = true;
    options.background = {0.12, 0.13, 0.15};
    options.foreground = {0.92, 0.92, 0.92};
    scene.set_options(options);
    scene.set_mesh(&mesh, &report);
    scene.set_highlighted_elements({3, 4});
    check_against_baseline(scene, "ring_nodes_dark");
}

TEST(Images, ClippedBall) {
    const CurvedMesh mesh = make_ball();
    const QualityReport report = make_report(mesh, {150, 200});
    MeshScene scene;
    SceneOptions options;
    options.clip = ClipPlane{{0.0, -1.0, 0.0}, 0.55};
    scene.set_options(options);
    scene.set_mesh(&mesh, &report);
    check_against_baseline(scene, "ball_clipped");
}

TEST(Images, BallCutThrough) {
    const CurvedMesh mesh = make_ball();
    const QualityReport report = make_report(mesh, {150, 219, 326}, {134});
    MeshScene scene;
    SceneOptions options;
    options.clip = ClipPlane{{0.0, -1.0, 0.0}, 0.55, ClipStyle::cut};
    options.show_nodes = true;
    scene.set_options(options);
    scene.set_mesh(&mesh, &report);
    scene.set_highlighted_elements({44});
    check_against_baseline(scene, "ball_cut");
}

TEST(Images, NumbersOnARing) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element}, {25});
    MeshScene scene;
    SceneOptions options;
    options.show_nodes = options.show_node_numbers = options.show_element_numbers = true;
    scene.set_options(options);
    scene.set_mesh(&mesh, &report);
    check_against_baseline(scene, "ring_numbers");
}

TEST(Images, OrthographicBallWithNumbersOnDark) {
    const CurvedMesh mesh = make_ball();
    const QualityReport report = make_report(mesh, {});
    MeshScene scene;
    SceneOptions options;
    options.is_orthographic = options.show_element_numbers = true;
    options.background = {0.12, 0.13, 0.15};
    options.foreground = {0.92, 0.92, 0.92};
    scene.set_options(options);
    scene.set_mesh(&mesh, &report);
    check_against_baseline(scene, "ball_orthographic_dark");
}

TEST(Images, WithoutAReport) {
    const CurvedMesh mesh = make_ball();
    MeshScene scene;
    scene.set_mesh(&mesh, nullptr);
    check_against_baseline(scene, "ball_plain");
}

TEST(Images, UnitAndOffsetDoNotShow) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element}, {25});
    MeshScene scene;
    scene.set_mesh(&mesh, &report);
    render_png(scene, width, height, output("unit"));
    const Image expected = read_image(output("unit"));
    for (const auto& other : {make_ring(1e-6), make_ring(1e6), make_ring(1.0, {1e6, -1e6, 1e6})}) {
        MeshScene its;
        its.set_mesh(&other, &report);
        render_png(its, width, height, output("unit"));
        EXPECT_TRUE(is_same(compare(read_image(output("unit")), expected)));
    }
}

// The negative control: pictures that differ as little as a user would care about must not pass for the same.
TEST(Images, ThresholdsTellPicturesApart) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element}, {25});
    const QualityReport none_tangled = make_report(mesh, {}, {25});
    QualityReport one_worse = report;
    one_worse.elements[2].scaled_jacobian *= 0.7;
    const auto draw = [&](const QualityReport& its, SceneOptions options) {
        MeshScene scene;
        scene.set_options(options);
        scene.set_mesh(&mesh, &its);
        render_png(scene, width, height, output("control"));
        return read_image(output("control"));
    };
    const Image reference = draw(report, {});
    EXPECT_TRUE(is_same(compare(draw(report, {}), reference)));
    EXPECT_FALSE(is_same(compare(draw(none_tangled, {}), reference)));
    EXPECT_FALSE(is_same(compare(draw(one_worse, {}), reference)));
    SceneOptions options;
    options.show_edges = false;
    EXPECT_FALSE(is_same(compare(draw(report, options), reference)));
    options = {};
    options.show_legend = false;
    EXPECT_FALSE(is_same(compare(draw(report, options), reference)));
}

}  // namespace
}  // namespace curvewright
