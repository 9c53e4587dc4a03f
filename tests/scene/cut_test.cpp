#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "core/basis/lagrange.h"
#include "tests/scene/image_compare.h"
#include "tests/scene/scene_window.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/offscreen.h"

namespace curvewright {
namespace {

/// Away with the half of the ball in which z > height, looked at from above.
SceneOptions cut_at(double height) {
    SceneOptions options;
    options.clip = ClipPlane{{0.0, 0.0, 1.0}, 0.5 * (1.0 + height), ClipStyle::cut};
    return options;
}

/// The same view without a window.
Image picture(const Window& its) {
    MeshScene scene;
    scene.set_options(its.scene.options());
    scene.set_mesh(&its.mesh, &its.report);
    scene.copy_view(its.scene);
    const auto file = temporary_picture("cut");
    render_png(scene, width, height, file);
    return read_image(file);
}

/// Whether a point is inside a curved tetrahedron, not too near its faces: by Newton's method.
bool is_inside(const CurvedMesh& mesh, Index element, const Eigen::RowVector3d& point) {
    const Eigen::MatrixX3d x = mesh.element_coordinates(element);
    if (((point - x.colwise().minCoeff()).minCoeff() < 0.0) || ((x.colwise().maxCoeff() - point).minCoeff() < 0.0))
        return false;
    Eigen::Vector3d at = Eigen::Vector3d::Constant(0.25);
    double distance = 1.0;
    for (int step = 0; step < 20 && distance > 1e-12; ++step) {
        const BasisTable table =
            lagrange_basis(mesh.topology().element_type(element), Eigen::MatrixX3d(at.transpose()));
        const Eigen::Vector3d rest = (table.values * x - point).transpose();
        distance = rest.norm();
        Eigen::Matrix3d jacobian;
        for (int d = 0; d < 3; ++d) jacobian.col(d) = (table.gradients[static_cast<std::size_t>(d)] * x).transpose();
        at -= jacobian.fullPivLu().solve(rest);
    }
    return distance < 1e-9 && at.minCoeff() > 0.03 && at.sum() < 0.97;
}

TEST(Cut, PicksTheElementThatThePlaneMeets) {
    Window its(make_ball());
    its.scene.set_options(cut_at(0.1));
    for (const bool is_orthographic : {false, true}) {
        SceneOptions options = cut_at(0.1);
        options.is_orthographic = is_orthographic;
        its.scene.set_options(options);
        its.scene.look(ViewDirection::plus_z);
        its.frame_start();
        int found = 0;
        for (double x = -0.4; x < 0.41; x += 0.1)
            for (double y = -0.4; y < 0.41; y += 0.1) {
                const Eigen::RowVector3d point(x + 0.013, y + 0.029, 0.1);
                for (Index element = 0; element < its.mesh.topology().element_count(); ++element) {
                    if (!is_inside(its.mesh, element, point)) continue;
                    const auto [sx, sy] = its.display(point);
                    EXPECT_EQ(its.scene.pick_element(sx, sy), element);
                    EXPECT_TRUE(its.scene.draws_element(element));
                    ++found;
                }
            }
        EXPECT_GT(found, 20);
    }
}

TEST(Cut, WhatIsCutAwayIsNotPicked) {
    Window its(make_ball());
    its.scene.look(ViewDirection::plus_y);  // from the side
    its.frame_start();
    const auto all = [](Index) { return true; };
    const auto above = its.display({0.0, 1.0, 0.5}), below = its.display({0.0, 1.0, -0.5});
    EXPECT_TRUE(its.scene.pick_element(above[0], above[1]).has_value());
    its.scene.set_options(cut_at(0.0));
    its.frame_start();
    EXPECT_FALSE(its.scene.pick_element(above[0], above[1]).has_value());
    EXPECT_TRUE(its.scene.pick_element(below[0], below[1]).has_value());
    Index top = 0, bottom = 0;
    for (Index node = 0; node < its.mesh.topology().node_count(); ++node) {
        const auto& x = its.mesh.coordinates();
        if (x.row(node).dot(Eigen::RowVector3d(0, 0.8, 0.6)) > x.row(top).dot(Eigen::RowVector3d(0, 0.8, 0.6)))
            top = node;
        if (x.row(node).dot(Eigen::RowVector3d(0, 0.8, -0.6)) > x.row(bottom).dot(Eigen::RowVector3d(0, 0.8, -0.6)))
            bottom = node;
    }
    const auto at_top = its.display(its.mesh.coordinates().row(top)),
               at_bottom = its.display(its.mesh.coordinates().row(bottom));
    EXPECT_NE(its.scene.pick_node(at_top[0], at_top[1], 3.0, all), top);
    EXPECT_EQ(its.scene.pick_node(at_bottom[0], at_bottom[1], 3.0, all), bottom);
    const std::vector<std::array<double, 2>> whole{{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}};
    for (const bool see_through : {false, true}) {
        for (const Index node : its.scene.nodes_inside(whole, see_through))
            EXPECT_LT(its.mesh.coordinates()(node, 2), 1e-5);
        const auto elements = its.scene.elements_inside(whole, see_through);
        EXPECT_GT(elements.size(), 20u);
        for (const Index element : elements) EXPECT_TRUE(its.scene.draws_element(element));
    }
    // Everything, and nothing.
    its.scene.set_options(cut_at(-1.0));
    its.frame_start();
    EXPECT_FALSE(its.scene.pick_element(below[0], below[1]).has_value());
    for (Index element = 0; element < its.mesh.topology().element_count(); ++element)
        EXPECT_FALSE(its.scene.draws_element(element));
    its.scene.set_options(cut_at(1.0));
    its.frame_start();
    EXPECT_TRUE(its.scene.pick_element(above[0], above[1]).has_value());
}

TEST(Cut, TheSectionHasTheColoursOfItsElements) {
    Window its(make_ball());
    SceneOptions options = cut_at(0.13);
    options.show_edges = false;
    options.is_orthographic = true;
    its.scene.set_options(options);
    its.scene.look(ViewDirection::plus_z);
    its.frame_start();
    const Image image = picture(its);
    int seen = 0;
    for (double x = -0.42; x < 0.43; x += 0.06)
        for (double y = -0.42; y < 0.43; y += 0.06) {
            const Eigen::RowVector3d point(x, y, 0.13);
            for (Index element = 0; element < its.mesh.topology().element_count(); ++element) {
                if (!is_inside(its.mesh, element, point)) continue;
                const auto [sx, sy] = its.display(point);
                const unsigned char* pixel = image.pixel(static_cast<int>(sx), static_cast<int>(sy));
                const ElementQuality& quality = its.report.elements[static_cast<std::size_t>(element)];
                const Color color = quality_color(quality.scaled_jacobian, quality.validity);
                for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], 255.0 * color[c], 4.0) << element;
                ++seen;
            }
        }
    EXPECT_GT(seen, 40);
    // Above the plane there is nothing but the ground.
    its.scene.look(ViewDirection::plus_x);
    its.frame_start();
    const Image side = picture(its);
    const auto free = its.display({0.0, 0.3, 0.2}), solid = its.display({0.0, 0.3, 0.05});
    EXPECT_EQ(side.pixel(static_cast<int>(free[0]), static_cast<int>(free[1]))[0], 255);
    EXPECT_LT(side.pixel(static_cast<int>(solid[0]), static_cast<int>(solid[1]))[0], 250);
}

TEST(Cut, TheEdgesEndAtThePlane) {
    Window its(make_ball());
    SceneOptions options = cut_at(0.0);
    options.show_nodes = true;
    options.show_legend = false;
    options.is_orthographic = true;
    its.scene.set_options(options);
    its.scene.look(ViewDirection::plus_x);
    its.frame_start();
    MeshScene drawn;
    drawn.set_options(options);
    const QualityReport tangled = make_report(its.mesh, {its.mesh.topology().element_count() - 1, 2}, {5, 380});
    drawn.set_mesh(&its.mesh, &tangled);
    drawn.set_highlighted_elements({0, its.mesh.topology().element_count() - 1});
    drawn.copy_view(its.scene);
    const auto file = temporary_picture("cut");
    render_png(drawn, width, height, file);
    const Image image = read_image(file);
    const int top = static_cast<int>(its.display({0.0, 0.0, 0.0})[1]) + 8;
    int drawn_above = 0, drawn_below = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) (y > top ? drawn_above : drawn_below) += image.pixel(x, y)[0] != 255;
    EXPECT_EQ(drawn_above, 0);
    EXPECT_GT(drawn_below, 5000);
}

TEST(Cut, FollowsAMotion) {
    Window its(make_ball());
    its.scene.set_options(cut_at(0.1));
    its.scene.look(ViewDirection::plus_z);
    its.frame_start();
    // The mesh slides half an element along its plane: another element is at the same place.
    Coordinates x = its.mesh.coordinates();
    x.col(0).array() += 0.3;
    its.scene.show_frame(x, nullptr);
    its.frame_start();
    int found = 0;
    for (double y = -0.35; y < 0.36; y += 0.05) {
        const Eigen::RowVector3d before(-0.12, y, 0.1);
        for (Index element = 0; element < its.mesh.topology().element_count(); ++element) {
            if (!is_inside(its.mesh, element, before)) continue;
            const auto [sx, sy] = its.display(before + Eigen::RowVector3d(0.3, 0.0, 0.0));
            EXPECT_EQ(its.scene.pick_element(sx, sy), element);
            ++found;
        }
    }
    EXPECT_GT(found, 5);
}

TEST(Cut, FlatMeshesAndWholeElementsAreAsBefore) {
    Window flat(make_ring());
    const Image before = picture(flat);
    SceneOptions options;
    options.clip = ClipPlane{{1.0, 0.0, 0.0}, 0.3, ClipStyle::cut};
    flat.scene.set_options(options);
    EXPECT_TRUE(is_same(compare(picture(flat), before)));

    // From one style to the other and back.
    Window its(make_ball());
    options.clip->style = ClipStyle::whole_elements;
    its.scene.set_options(options);
    const Image whole = picture(its);
    options.clip->style = ClipStyle::cut;
    its.scene.set_options(options);
    const Image cut = picture(its);
    EXPECT_FALSE(is_same(compare(cut, whole)));
    options.clip->style = ClipStyle::whole_elements;
    its.scene.set_options(options);
    EXPECT_TRUE(is_same(compare(picture(its), whole)));
}

TEST(Cut, FocusLooksAtTheSection) {
    Window its(make_ball());
    its.scene.set_options(cut_at(0.1));
    its.frame_start();
    for (Index element = 0; element < its.mesh.topology().element_count(); ++element) {
        if (!is_inside(its.mesh, element, {0.11, 0.03, 0.1})) continue;
        its.scene.focus_element(element);
        its.frame_start();
        EXPECT_NEAR(its.scene.view_axes()(2, 2), 1.0, 1e-6);  // from above
    }
}

TEST(Cut, ShrunkElementsAndSomeElementsAreCutToo) {
    Window its(make_ball());
    SceneOptions options = cut_at(0.1);
    options.only_elements = std::vector<Index>{};
    for (Index element = 0; element < its.mesh.topology().element_count(); element += 2)
        options.only_elements->push_back(element);
    options.element_size = 0.8;
    its.scene.set_options(options);
    its.scene.look(ViewDirection::plus_z);
    its.frame_start();
    int some = 0, none = 0;
    for (Index element = 0; element < its.mesh.topology().element_count(); ++element) {
        if (!is_inside(its.mesh, element, its.mesh.element_center(element))) continue;
        const Eigen::RowVector3d center = its.mesh.element_center(element);
        if (element % 2 == 1) {
            EXPECT_FALSE(its.scene.draws_element(element));
            ++none;
        } else if (std::abs(center[2] - 0.1) < 1e-9 || center[2] < 0.1) {
            some += its.scene.draws_element(element);
        }
    }
    EXPECT_GT(some, 20);
    EXPECT_GT(none, 20);
}

}  // namespace
}  // namespace curvewright
