#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkRenderer.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "tests/scene/image_compare.h"
#include "tests/scene/scene_meshes.h"
#include "ui/scene/indexed_picture.h"
#include "ui/scene/offscreen.h"
#include "ui/scene/picture_pixels.h"

namespace curvewright {
namespace {

std::filesystem::path output() {
    return temporary_picture("offscreen");
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

TEST(Offscreen, ATransparentPictureLaidOnAGroundIsThePictureOnThatGround) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {});
    MeshScene scene;
    SceneOptions options;
    options.show_nodes = true;
    scene.set_options(options);
    scene.set_mesh(&mesh, &report);
    const int width = 300, height = 220;
    render_png(scene, width, height, output(), PictureGround::transparent);
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(output().c_str());
    reader->Update();
    vtkImageData* transparent = reader->GetOutput();
    ASSERT_EQ(transparent->GetNumberOfScalarComponents(), 4);
    const auto* rgba = static_cast<const unsigned char*>(transparent->GetScalarPointer());
    EXPECT_EQ(scene.renderer()->GetBackground()[0], options.background[0]);

    // The ground alone changes; halos and the legend's box stay white.
    const auto on_ground = [&](const Color& ground, std::size_t pixel, std::size_t c) {
        const double alpha = rgba[4 * pixel + 3] / 255.0;
        return alpha * rgba[4 * pixel + c] + (1.0 - alpha) * 255.0 * ground[c];
    };
    render_png(scene, width, height, output());
    const Image opaque = read_image(output());
    int clear = 0, partly = 0, solid = 0;
    double largest = 0.0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            const unsigned char alpha = rgba[4 * pixel + 3];
            ++(alpha == 0 ? clear : alpha == 255 ? solid : partly);
            for (std::size_t c = 0; c < 3; ++c)
                largest = std::max(largest, std::abs(on_ground(options.background, pixel, c) - opaque.pixel(x, y)[c]));
        }
    EXPECT_LT(largest, 2.01);
    EXPECT_GT(clear, width * height / 5);
    EXPECT_GT(solid, width * height / 10);
    EXPECT_GT(partly, 200);
    EXPECT_EQ(rgba[3], 0);  // a corner
}

TEST(Offscreen, HalfCoveredPixelsKeepTheirColour) {
    // A line of (200, 100, 0) that covers a quarter, half and all of a pixel.
    std::vector<unsigned char> black, white;
    for (const double cover : {0.0, 0.25, 0.5, 1.0})
        for (const double channel : {200.0, 100.0, 0.0}) {
            black.push_back(static_cast<unsigned char>(std::lround(cover * channel)));
            white.push_back(static_cast<unsigned char>(std::lround(cover * channel + (1.0 - cover) * 255.0)));
        }
    const PicturePixels pixels = without_ground(black.data(), white.data(), 4, 1, 1);
    EXPECT_EQ(pixels.channels, 4);
    EXPECT_EQ(pixels.bytes[3], 0);
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_NEAR(pixels.bytes[4 * i], 200, 2);
        EXPECT_NEAR(pixels.bytes[4 * i + 1], 100, 2);
        EXPECT_EQ(pixels.bytes[4 * i + 2], 0);
    }
    EXPECT_NEAR(pixels.bytes[7], 64, 1);
    EXPECT_NEAR(pixels.bytes[11], 128, 1);
    EXPECT_EQ(pixels.bytes[15], 255);
    // Two by two: covered by a half in one pixel and wholly in another.
    const std::vector<unsigned char> black4{100, 50, 0, 200, 100, 0, 0, 0, 0, 0, 0, 0};
    const std::vector<unsigned char> white4{228, 178, 128, 200, 100, 0, 255, 255, 255, 255, 255, 255};
    const PicturePixels block = without_ground(black4.data(), white4.data(), 2, 2, 2);
    EXPECT_NEAR(block.bytes[0], 200, 2);
    EXPECT_NEAR(block.bytes[1], 100, 2);
    EXPECT_NEAR(block.bytes[3], 96, 1);
}

TEST(IndexedPicture, FewColoursStayWhatTheyAre) {
    // Two rows from the bottom: red red, white black.
    const PicturePixels picture{2, 2, 3, {200, 0, 0, 200, 0, 0, 255, 255, 255, 0, 0, 0}};
    const IndexedPicture indexed = reduce_colors(picture, 256);
    ASSERT_EQ(indexed.palette.size(), 3u);
    const auto color = [&](std::size_t i) { return indexed.palette[indexed.indices[i]]; };
    using Rgb = std::array<unsigned char, 3>;
    EXPECT_EQ(color(0), (Rgb{255, 255, 255}));
    EXPECT_EQ(color(1), (Rgb{0, 0, 0}));
    EXPECT_EQ(color(2), (Rgb{200, 0, 0}));
    EXPECT_EQ(color(3), (Rgb{200, 0, 0}));
}

TEST(IndexedPicture, ManyColoursBecomeSimilarOnes) {
    MeshScene scene;
    const CurvedMesh ring = make_ring();
    scene.set_mesh(&ring, nullptr);
    const PicturePixels picture = render_pixels(scene, 160, 120);
    const IndexedPicture indexed = reduce_colors(picture, 16);
    EXPECT_EQ(indexed.palette.size(), 16u);
    const auto file = output();
    write_text_file(file, to_png(indexed));
    const Image image = read_image(file);
    ASSERT_EQ(image.width, 160);
    ASSERT_EQ(image.height, 120);
    int most = 0;
    for (std::size_t i = 0; i < picture.bytes.size(); ++i)
        most = std::max(most, std::abs(image.rgb[i] - picture.bytes[i]));
    EXPECT_GT(most, 0);
    EXPECT_LT(most, 40);
    EXPECT_TRUE(is_close(image.pixel(0, 0), {1.0, 1.0, 1.0}));
    EXPECT_EQ(image.pixel(0, 0)[0], 255);
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
