/// What the colours show: arrays on nodes and elements, distances, ranges, in pixels.

#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkRenderer.h>

#include "tests/scene/image_compare.h"
#include "tests/scene/scene_meshes.h"
#include "tests/support/mesh_factory.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/offscreen.h"
#include "ui/scene/surface_parts.h"

namespace curvewright {
namespace {

constexpr int width = 420, height = 300;

std::filesystem::path output() {
    return temporary_picture("coloring");
}

/// A picture of a flat mesh that fills its bounding box, without inner lines, and what it takes to ask it for the
/// colour of a point.
struct Picture {
    Picture(const CurvedMesh& mesh, const QualityReport* report, const Coloring& coloring) : box(bounding_box(mesh)) {
        SceneOptions options;
        options.show_edges = false;
        scene.set_options(options);
        scene.set_coloring(coloring);
        scene.set_mesh(&mesh, report);
        draw();
    }
    void draw() {
        render_png(scene, width, height, output());
        image = read_image(output());
        // Where the mesh is: from the ground's last pixels to the legend.
        left = width, right = 0, bottom = height, top = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width - 122; ++x) {
                const unsigned char* pixel = image.pixel(x, y);
                if (pixel[0] + pixel[1] + pixel[2] > 3 * 252) continue;
                left = std::min(left, x), right = std::max(right, x);
                bottom = std::min(bottom, y), top = std::max(top, y);
            }
    }
    Color at(const Eigen::RowVector3d& point) const {
        const Eigen::RowVector3d share = (point - box.row(0)).cwiseQuotient(box.row(1) - box.row(0));
        const unsigned char* pixel = image.pixel(left + static_cast<int>(std::lround(share[0] * (right - left))),
                                                 bottom + static_cast<int>(std::lround(share[1] * (top - bottom))));
        return {pixel[0] / 255.0, pixel[1] / 255.0, pixel[2] / 255.0};
    }

    MeshScene scene;
    Eigen::Matrix<double, 2, 3> box;
    Image image;
    int left = 0, right = 0, bottom = 0, top = 0;
};

void expect_close(const Color& a, const Color& b, double tolerance, const std::string& what) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << what;
}

Coloring array_coloring(FieldArray::Place place, int components, std::vector<double> values) {
    Coloring coloring;
    coloring.source = Coloring::Source::array;
    coloring.map = ColorMap::deep;
    coloring.title = "an array";
    auto array = std::make_shared<FieldArray>();
    array->place = place;
    array->components = components;
    array->values = std::move(values);
    coloring.array = std::move(array);
    return coloring;
}

double cubic(double x, double y) {
    return 4.0 * std::pow(x - 0.5, 3) + x * y;
}

/// Values of a function at the nodes.
template <class Function>
std::vector<double> at_nodes(const CurvedMesh& mesh, const Function& function) {
    std::vector<double> values;
    for (Eigen::Index i = 0; i < mesh.coordinates().rows(); ++i)
        values.push_back(function(mesh.coordinates()(i, 0), mesh.coordinates()(i, 1)));
    return values;
}

int visible_actors(const MeshScene& scene) {
    vtkActorCollection* actors = scene.renderer()->GetActors();
    int count = 0;
    for (int i = 0; i < actors->GetNumberOfItems(); ++i)
        count += static_cast<vtkActor*>(actors->GetItemAsObject(i))->GetVisibility() ? 1 : 0;
    return count;
}

TEST(Coloring, ACubicFieldOnTwoStraightTrianglesLooksCubic) {
    const CurvedMesh mesh = testing::square_mesh(1, 3);
    Coloring coloring = array_coloring(FieldArray::Place::nodes, 1, at_nodes(mesh, cubic));
    const Picture picture(mesh, nullptr, coloring);
    const ColorScale& scale = picture.scene.shown_scale();
    // The range is that of the nodes.
    EXPECT_DOUBLE_EQ(scale.lower, -0.5);
    EXPECT_DOUBLE_EQ(scale.upper, 1.5);
    double largest = 0.0;
    for (double x = 0.05; x < 1.0; x += 0.1)
        for (double y = 0.05; y < 1.0; y += 0.1) {
            const Color seen = picture.at({x, y, 0.0});
            expect_close(seen, scale.color_of(cubic(x, y)), 0.045, "at " + std::to_string(x) + " " + std::to_string(y));
            // The negative control: what linear interpolation between the corners would show.
            const double corners = x * cubic(1, 0) + (1 - x) * cubic(0, 0) + y * (cubic(0, 1) - cubic(0, 0));
            largest = std::max(largest, std::abs(seen[0] - scale.color_of(corners)[0]));
        }
    EXPECT_GT(largest, 0.1);
}

TEST(Coloring, VectorsByLengthAndComponent) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    std::vector<double> values;
    for (const double x : at_nodes(mesh, [](double x, double) { return x; }))
        values.insert(values.end(), {x - 0.5, 0.25, 0.0});
    Coloring coloring = array_coloring(FieldArray::Place::nodes, 3, values);
    const Picture length(mesh, nullptr, coloring);
    EXPECT_DOUBLE_EQ(length.scene.shown_scale().lower, 0.25);
    expect_close(length.at({0.5, 0.3, 0}), length.scene.shown_scale().color_of(0.25), 0.03, "length");
    expect_close(length.at({0.9, 0.3, 0}), length.scene.shown_scale().color_of(std::hypot(0.4, 0.25)), 0.03, "length");
    coloring.component = 0;
    coloring.map = ColorMap::balance;
    const Picture x(mesh, nullptr, coloring);
    EXPECT_DOUBLE_EQ(x.scene.shown_scale().lower, -0.5);
    expect_close(x.at({0.2, 0.3, 0}), x.scene.shown_scale().color_of(-0.3), 0.03, "x");
    expect_close(x.at({0.8, 0.3, 0}), x.scene.shown_scale().color_of(0.3), 0.03, "x");
}

TEST(Coloring, ElementsHaveOneColourEach) {
    const CurvedMesh mesh = testing::square_mesh(2, 1);
    std::vector<double> values = {10, 20, 30, 40, 50, 60, 70, std::numeric_limits<double>::quiet_NaN()};
    const Coloring coloring = array_coloring(FieldArray::Place::elements, 1, values);
    const Picture picture(mesh, nullptr, coloring);
    EXPECT_DOUBLE_EQ(picture.scene.shown_scale().lower, 10.0);
    EXPECT_DOUBLE_EQ(picture.scene.shown_scale().upper, 70.0);
    for (Index element = 0; element < 8; ++element)
        expect_close(picture.at(mesh.element_center(element)),
                     picture.scene.shown_scale().color_of(values[static_cast<std::size_t>(element)]), 0.006,
                     std::to_string(element));
}

TEST(Coloring, AGivenRangeClampsAndMayBeOpenAtOneEnd) {
    const CurvedMesh mesh = testing::square_mesh(2, 3);
    Coloring coloring = array_coloring(FieldArray::Place::nodes, 1, at_nodes(mesh, [](double x, double) { return x; }));
    coloring.lower = 0.25;
    coloring.upper = 0.5;
    coloring.is_reversed = true;
    const Picture picture(mesh, nullptr, coloring);
    expect_close(picture.at({0.05, 0.4, 0}), map_color(ColorMap::deep, 1.0), 0.006, "below");
    expect_close(picture.at({0.9, 0.4, 0}), map_color(ColorMap::deep, 0.0), 0.006, "above");
    expect_close(picture.at({0.375, 0.4, 0}), map_color(ColorMap::deep, 0.5), 0.03, "within");
    coloring.upper.reset();
    const Picture open(mesh, nullptr, coloring);
    EXPECT_DOUBLE_EQ(open.scene.shown_scale().lower, 0.25);
    EXPECT_DOUBLE_EQ(open.scene.shown_scale().upper, 1.0);
}

TEST(Coloring, DistancesFollowEveryFrame) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    Coloring coloring;
    coloring.source = Coloring::Source::distance_moved;
    coloring.map = ColorMap::deep;
    coloring.reference = std::make_shared<const Coordinates>(mesh.coordinates());
    Picture picture(mesh, nullptr, coloring);
    expect_close(picture.at({0.3, 0.3, 0}), map_color(ColorMap::deep, 0.0), 0.006, "at rest");
    Coordinates moved = mesh.coordinates();
    moved.col(0) *= 0.5;
    picture.scene.show_frame(moved, nullptr);
    picture.box = bounding_box(mesh.with_coordinates(moved));
    picture.draw();
    EXPECT_DOUBLE_EQ(picture.scene.shown_scale().upper, 0.5);
    expect_close(picture.at({0.25, 0.5, 0}), map_color(ColorMap::deep, 0.5), 0.03, "half way");
    expect_close(picture.at({0.47, 0.5, 0}), map_color(ColorMap::deep, 0.94), 0.03, "nearly all of it");
}

TEST(Coloring, TangledElementsStandOutWhateverIsShown) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element});
    const auto alarm_pixels = [&](const Coloring& coloring, const QualityReport& its) {
        Picture picture(mesh, &its, coloring);
        int count = 0;
        for (int y = 0; y < picture.image.height; ++y)
            for (int x = 0; x < 300; ++x) {  // without the legend
                const unsigned char* pixel = picture.image.pixel(x, y);
                double off = 0.0;
                for (std::size_t c = 0; c < 3; ++c)
                    off = std::max(off, std::abs(pixel[c] - 255.0 * tangled_color()[c]));
                count += off < 3.0;
            }
        return count;
    };
    const int as_quality = alarm_pixels({}, report);
    EXPECT_GT(as_quality, 100);
    Coloring plain;
    plain.source = Coloring::Source::plain;
    const Coloring on_nodes = array_coloring(FieldArray::Place::nodes, 1, at_nodes(mesh, cubic));
    const Coloring on_elements =
        array_coloring(FieldArray::Place::elements, 1,
                       std::vector<double>(static_cast<std::size_t>(mesh.topology().element_count()), 3.0));
    for (const Coloring& coloring : {plain, on_nodes, on_elements}) {
        EXPECT_GT(alarm_pixels(coloring, report), as_quality / 2);
        EXPECT_EQ(alarm_pixels(coloring, make_report(mesh, {})), 0);
    }
}

TEST(Coloring, RangeAndMapOfTheScaledJacobian) {
    const CurvedMesh mesh = testing::square_mesh(2, 1);
    QualityReport report;
    report.elements.resize(8);
    for (std::size_t i = 0; i < 8; ++i) {
        report.elements[i].scaled_jacobian = 0.05 + 0.1 * static_cast<double>(i);
        report.elements[i].validity = Validity::valid;
    }
    report.summary = {0.05, 0.4, 0.75, 8, 0, 0};
    Coloring coloring;
    coloring.upper = 0.3;
    coloring.map = ColorMap::grey;
    const Picture picture(mesh, &report, coloring);
    for (Index element = 0; element < 8; ++element)
        expect_close(picture.at(mesh.element_center(element)),
                     map_color(ColorMap::grey, (0.05 + 0.1 * static_cast<double>(element)) / 0.3), 0.006,
                     std::to_string(element));
}

TEST(Coloring, ASurfaceInPartsLooksAsInOne) {
    for (const CurvedMesh& mesh : {make_ring(), make_ball()}) {
        const QualityReport report = make_report(mesh, {}), other = make_report(mesh, {3});
        Coordinates bent = mesh.coordinates();
        bent.col(0) += 0.1 * bent.col(1).cwiseAbs2();
        FieldArray squares;
        squares.name = "squares";
        squares.place = FieldArray::Place::nodes;
        for (Index node = 0; node < mesh.topology().node_count(); ++node)
            squares.values.push_back(mesh.coordinates().row(node).squaredNorm());
        Coloring by_nodes;
        by_nodes.source = Coloring::Source::array;
        by_nodes.array = std::make_shared<const FieldArray>(squares);
        for (const Coloring& coloring : {Coloring(), by_nodes}) {
            const auto pictures = [&](int& actors) {
                Picture picture(mesh, &report, coloring);
                std::vector<std::vector<unsigned char>> all{picture.image.rgb};
                actors = visible_actors(picture.scene);
                picture.scene.show_frame(bent, &other);
                picture.draw();
                all.push_back(picture.image.rgb);
                picture.scene.set_mesh(&mesh, &report);
                picture.draw();
                all.push_back(picture.image.rgb);
                return all;
            };
            int in_one = 0, in_parts = 0;
            const auto whole = pictures(in_one);
            const std::size_t few = std::exchange(SurfaceParts::few_triangles, 1);
            const auto parts = pictures(in_parts);
            SurfaceParts::few_triangles = few;
            EXPECT_GE(in_parts, in_one + 3);
            EXPECT_EQ(parts, whole);
            EXPECT_NE(whole[0], whole[1]);
        }
    }
}

TEST(Coloring, ArraysThatDoNotFitShowNothing) {
    const CurvedMesh mesh = testing::square_mesh(2, 1);
    const Coloring coloring = array_coloring(FieldArray::Place::nodes, 1, {1, 2, 3});
    const Picture picture(mesh, nullptr, coloring);
    Coloring plain;
    plain.source = Coloring::Source::plain;
    const Picture expected(mesh, nullptr, plain);
    EXPECT_TRUE(is_same(compare(picture.image, expected.image)));
    // A field takes its place, and goes again.
    Picture changing(mesh, nullptr, plain);
    changing.scene.set_coloring(array_coloring(FieldArray::Place::nodes, 1, at_nodes(mesh, cubic)));
    changing.draw();
    EXPECT_FALSE(is_same(compare(changing.image, expected.image)));
    changing.scene.set_coloring(plain);
    changing.draw();
    EXPECT_TRUE(is_same(compare(changing.image, expected.image)));
}

TEST(Coloring, TheLegendIsWhereItIsDrawn) {
    const CurvedMesh mesh = testing::square_mesh(2, 3);
    Picture picture(mesh, nullptr, array_coloring(FieldArray::Place::nodes, 1, at_nodes(mesh, cubic)));
    // Pictures are drawn at twice their size.
    EXPECT_TRUE(picture.scene.is_on_legend(2 * (width - 40.0), height));
    EXPECT_FALSE(picture.scene.is_on_legend(width, height));
    // Its bar has the colours of the range from bottom to top.
    int last = -1;
    for (int y = height / 2 - 50; y <= height / 2 + 30; y += 10) {
        const int green = picture.image.pixel(width - 103, y)[1];
        EXPECT_GT(green, last) << y;
        last = green;
    }
    picture.scene.set_mesh(nullptr, nullptr);
    picture.draw();
    EXPECT_FALSE(picture.scene.is_on_legend(2 * (width - 40.0), height));
}

}  // namespace
}  // namespace curvewright
