#include "ui/scene/report_painter.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/scene/image_compare.h"
#include "tests/support/mesh_factory.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/offscreen.h"

namespace curvewright {
namespace {

Image image_of(const std::string& png) {
    const auto file = temporary_picture("report");
    std::ofstream(file, std::ios::binary) << png;
    return read_image(file);
}

/// Pixels of a colour.
int count_of(const Image& image, const Color& color) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const unsigned char* pixel = image.pixel(x, y);
            bool is_same = true;
            for (std::size_t c = 0; c < 3; ++c) is_same = is_same && std::abs(pixel[c] - 255.0 * color[c]) < 3.0;
            count += is_same ? 1 : 0;
        }
    return count;
}

TEST(ReportPainter, HasTheColoursOfTheWindow) {
    const ReportColors colors = report_colors();
    EXPECT_EQ(colors.tangled, "#d6006c");
    EXPECT_EQ(colors.undecided, "#7a68a8");
    const Color best = quality_map(1.0);
    char text[8];
    std::snprintf(text, sizeof text, "#%02lx%02lx%02lx", std::lround(255 * best[0]), std::lround(255 * best[1]),
                  std::lround(255 * best[2]));
    EXPECT_EQ(colors.of(1.0), text);
}

TEST(ReportPainter, DrawsInMemoryWhatItWritesToFiles) {
    const CurvedMesh mesh = testing::square_mesh(3, 2);
    const QualityReport report = assess_quality(mesh);
    MeshScene scene;
    scene.set_mesh(&mesh, &report);
    const auto file = temporary_picture("report");
    render_png(scene, 200, 150, file);
    const Image image = read_image(file), other = image_of(draw_png(scene, 200, 150));
    ASSERT_EQ(other.width, 200);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) ASSERT_EQ(image.pixel(x, y)[c], other.pixel(x, y)[c]);
}

TEST(ReportPainter, ShowsAnElementAmongItsNeighboursFromTheSamePlace) {
    const CurvedMesh before = testing::bulged_square_mesh(6, 3, 0.1), after = testing::square_mesh(6, 3);
    const QualityReport quality_before = assess_quality(before), quality_after = assess_quality(after);
    const Index worst = quality_before.worst(1).front();
    ReportPainter painter(before, quality_before, after, quality_after);
    const Image was = image_of(painter.paint({worst, false, 240, 160}));
    const Image is = image_of(painter.paint({worst, true, 240, 160}));
    const Color accent = SceneOptions().accent, calm = quality_color(1.0, Validity::valid);
    EXPECT_GT(count_of(was, tangled_color()), 100);
    EXPECT_EQ(count_of(is, tangled_color()), 0);
    // The outline; the element and its neighbours fill a good part, and the whole mesh is not in it.
    EXPECT_GT(count_of(was, accent), 100);
    EXPECT_GT(count_of(is, accent), 100);
    EXPECT_GT(count_of(is, calm), 240 * 160 / 4);
    // Whatever was painted in between, the same comes out.
    painter.paint({std::nullopt, true, 120, 90});
    painter.paint({0, true, 120, 90});
    EXPECT_EQ(count_of(image_of(painter.paint({worst, false, 240, 160})), tangled_color()),
              count_of(was, tangled_color()));
    // From near: the outline of the element is longer than in a picture of the whole.
    const Image whole = image_of(painter.paint({std::nullopt, false, 240, 160}));
    EXPECT_EQ(count_of(whole, accent), 0);
    EXPECT_LT(count_of(whole, tangled_color()), 4 * count_of(was, tangled_color()));
}

TEST(ReportPainter, SeesElementsInsideASolid) {
    const CurvedMesh mesh = testing::cube_mesh(3, 2);
    const QualityReport quality = assess_quality(mesh);
    // The element in the middle of the cube.
    Index middle = 0;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const Eigen::RowVector3d to_middle = mesh.element_center(element).array() - 0.5;
        const Eigen::RowVector3d best = mesh.element_center(middle).array() - 0.5;
        if (to_middle.norm() < best.norm()) middle = element;
    }
    ReportPainter painter(mesh, quality, mesh, quality);
    EXPECT_GT(count_of(image_of(painter.paint({middle, false, 240, 160})), SceneOptions().accent), 100);
}

}  // namespace
}  // namespace curvewright
