#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include "core/base/error.h"
#include "tests/scene/image_compare.h"
#include "tests/scene/scene_meshes.h"
#include "ui/scene/offscreen.h"

namespace curvewright {
namespace {

std::filesystem::path output() {
    return std::filesystem::temp_directory_path() / "curvewright_offscreen.png";
}

bool is_close(const unsigned char* pixel, const Color& color) {
    for (std::size_t c = 0; c < 3; ++c)
        if (std::abs(pixel[c] - 255.0 * color[c]) > 2.0) return false;
    return true;
}

TEST(Offscreen, DrawsTheSizeThatIsAskedFor) {
    MeshScene scene;
    for (const auto& [width, height] : {std::pair(320, 200), {61, 47}, {1, 1}}) {
        render_png(scene, width, height, output());
        const Image image = read_image(output());
        EXPECT_EQ(image.width, width);
        EXPECT_EQ(image.height, height);
    }
}

TEST(Offscreen, AnEmptySceneIsAllBackground) {
    MeshScene scene;
    SceneOptions options;
    options.background = {0.25, 0.5, 0.75};
    scene.set_options(options);
    render_png(scene, 64, 48, output());
    const Image image = read_image(output());
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) EXPECT_TRUE(is_close(image.pixel(x, y), options.background));
}

TEST(Offscreen, ElementsHaveTheColourOfTheirQuality) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {});
    MeshScene scene;
    SceneOptions options;
    options.show_edges = false;
    scene.set_options(options);
    scene.set_mesh(&mesh, &report);
    for (Index element : {2, 9, 20, 30}) {
        scene.focus_element(element);
        render_png(scene, 301, 301, output());
        // The legend moves the middle of the view to the left; the element is a fifth of the height.
        const Image image = read_image(output());
        const Color expected = quality_color(report.elements[element].scaled_jacobian, Validity::valid);
        int count = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < 180; ++x) count += is_close(image.pixel(x, y), expected);
        EXPECT_GT(count, 400) << element;
    }
}

TEST(Offscreen, TheSceneKeepsItsOptions) {
    MeshScene scene;
    render_png(scene, 64, 48, output());
    EXPECT_EQ(scene.options().pixel_ratio, 1.0);
    EXPECT_EQ(scene.renderer()->GetRenderWindow(), nullptr);
}

TEST(Offscreen, RefusesWhatCannotBeDone) {
    MeshScene scene;
    EXPECT_THROW(render_png(scene, 0, 10, output()), Unsupported);
    EXPECT_THROW(render_png(scene, 10, 100000, output()), Unsupported);
    EXPECT_THROW(render_png(scene, 10, 10, "/nonexistent-folder/picture.png"), InvalidInput);
    vtkNew<vtkGenericOpenGLRenderWindow> window;
    window->AddRenderer(scene.renderer());
    EXPECT_THROW(render_png(scene, 10, 10, output()), Unsupported);
    window->RemoveRenderer(scene.renderer());
}

}  // namespace
}  // namespace curvewright
