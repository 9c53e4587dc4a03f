#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/scene/scene_window.h"

namespace curvewright {
namespace {

SceneOptions orthographic() {
    SceneOptions options;
    options.is_orthographic = true;
    return options;
}

struct Box {
    double left = 1e9, bottom = 1e9, right = -1e9, top = -1e9;
};

Box shown_box(Window& its) {
    Box box;
    for (Index node = 0; node < its.mesh.topology().node_count(); ++node) {
        const auto [x, y] = its.display(its.mesh.coordinates().row(node));
        box = {std::min(box.left, x), std::min(box.bottom, y), std::max(box.right, x), std::max(box.top, y)};
    }
    return box;
}

TEST(Orthographic, ParallelLinesStayParallel) {
    Window its(make_ball());
    const auto edge = [&](double y) {
        const auto a = its.display({0.0, y, -0.5}), b = its.display({0.0, y, 0.5});
        return Eigen::Vector2d(b[0] - a[0], b[1] - a[1]);
    };
    const auto difference = [&] { return (edge(-0.9) - edge(0.9)).norm(); };
    EXPECT_GT(difference(), 3.0);
    its.scene.set_options(orthographic());
    its.frame_start();
    EXPECT_LT(difference(), 1e-6);
    EXPECT_FALSE(its.scene.is_flat());
    its.scene.set_options({});
    its.frame_start();
    EXPECT_GT(difference(), 3.0);
}

TEST(Orthographic, TheWholeMeshFitsFromEverySide) {
    for (const double unit : {1.0, 1e-6, 1e6}) {
        CurvedMesh ball = make_ball();
        ball = ball.with_coordinates(unit * ball.coordinates());
        Window its(ball);
        its.scene.set_options(orthographic());
        for (const ViewDirection direction :
             {ViewDirection::isometric, ViewDirection::plus_x, ViewDirection::minus_z}) {
            its.scene.look(direction);
            its.frame_start();
            const Box box = shown_box(its);
            EXPECT_GT(box.left, 5.0);
            EXPECT_GT(box.bottom, 5.0);
            EXPECT_LT(box.top, height - 5.0);
            EXPECT_LT(box.right, width - 100.0);
            EXPECT_GT(box.top - box.bottom, 0.8 * height);
            // In front of the eye, within the depth that is drawn.
            for (Index node = 0; node < its.mesh.topology().node_count(); node += 9)
                EXPECT_LT(std::abs(its.scene.project(its.mesh.coordinates().row(node))[2]), 1.0);
        }
    }
}

TEST(Orthographic, SwitchingKeepsWhatIsLookedAt) {
    Window its(make_ball());
    its.drag(200, 150, 240, 170);
    its.at(250, 200);
    its.interactor->InvokeEvent(vtkCommand::MouseWheelForwardEvent);
    its.frame_start();
    const auto before = its.camera();
    const Eigen::RowVector3d focal(before[3], before[4], before[5]);
    const Eigen::RowVector3d beside = its.frame.to_mesh(focal + 0.05 * its.scene.view_axes().col(0).transpose());
    const auto at_before = its.display(beside);
    its.scene.set_options(orthographic());
    its.frame_start();
    const auto at_after = its.display(beside);
    EXPECT_NEAR(at_after[0], at_before[0], 0.01);
    EXPECT_NEAR(at_after[1], at_before[1], 0.01);
    its.scene.set_options({});
    its.frame_start();
    const auto camera = its.camera();
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(camera[i], before[i], 1e-6);
    // One that was kept fitted stays so.
    Window fitted(make_ball());
    fitted.scene.set_options(orthographic());
    fitted.window->SetSize(1200, 900);
    fitted.frame_start();
    const Box box = shown_box(fitted);
    EXPECT_GT(box.top - box.bottom, 0.8 * 900.0);
    EXPECT_LT(box.top, 900.0);
}

TEST(Orthographic, TheMouseZoomsPansAndTurns) {
    Window its(make_ball());
    its.scene.set_options(orthographic());
    its.frame_start();
    const Eigen::RowVector3d point(0.3, -0.4, 0.5);
    const auto start = its.display(point);
    const double unit = its.scene.units_per_pixel(point);
    its.at(start[0], start[1]);
    its.interactor->InvokeEvent(vtkCommand::MouseWheelForwardEvent);
    its.frame_start();
    EXPECT_NEAR(its.display(point)[0], start[0], 1.0);
    EXPECT_NEAR(its.display(point)[1], start[1], 1.0);
    EXPECT_LT(its.scene.units_per_pixel(point), 0.95 * unit);
    // The unit is the same at every depth, and true.
    EXPECT_NEAR(its.scene.units_per_pixel({0.0, 1.0, 0.0}), its.scene.units_per_pixel({0.0, -1.0, 0.0}), 1e-12);
    const Eigen::RowVector3d right = its.scene.view_axes().col(0).transpose();
    const auto a = its.display(point), b = its.display(point + 0.1 * right);
    EXPECT_NEAR(0.1 / (b[0] - a[0]), its.scene.units_per_pixel(point), 1e-5);

    const auto before = its.display({0.0, 0.0, 0.0});
    its.drag(200, 150, 230, 170, true);
    EXPECT_NEAR(its.display({0.0, 0.0, 0.0})[0] - before[0], 30.0, 1e-3);
    EXPECT_NEAR(its.display({0.0, 0.0, 0.0})[1] - before[1], 20.0, 1e-3);
    const Eigen::Matrix3d axes = its.scene.view_axes();
    its.drag(200, 150, 260, 150);
    EXPECT_GT((its.scene.view_axes() - axes).norm(), 0.1);
    // A point comes back from the screen.
    const Eigen::Vector4d at = its.scene.project(point);
    EXPECT_LT((its.scene.unproject(at[0], at[1], point) - point).norm(), 1e-6);
}

TEST(Orthographic, PicksWhatIsInFront) {
    Window its(make_ball());
    its.scene.set_options(orthographic());
    for (const double sign : {1.0, -1.0}) {
        its.scene.look(sign > 0.0 ? ViewDirection::plus_z : ViewDirection::minus_z);
        its.frame_start();
        const auto [x, y] = its.display({0.03, 0.02, sign});
        const auto picked = its.scene.pick_element(x, y);
        ASSERT_TRUE(picked.has_value());
        EXPECT_GT(sign * its.mesh.element_center(*picked)[2], 0.5);
        // Of two nodes one behind the other, the nearer.
        Index near = 0;
        for (Index node = 0; node < its.mesh.topology().node_count(); ++node)
            if (sign * its.mesh.coordinates()(node, 2) > sign * its.mesh.coordinates()(near, 2)) near = node;
        const auto at = its.display(its.mesh.coordinates().row(near));
        EXPECT_EQ(its.scene.pick_node(at[0], at[1], 3.0, [](Index) { return true; }), near);
    }
}

TEST(Orthographic, FocusAndCopiesOfTheView) {
    Window its(make_ball());
    its.scene.set_options(orthographic());
    const Index element = 30;
    its.scene.focus_element(element);
    its.frame_start();
    double bottom = height, top = 0.0;
    for (const Eigen::MatrixX3d x = its.mesh.element_coordinates(element); const auto& row : x.rowwise()) {
        const auto at = its.display(row);
        bottom = std::min(bottom, at[1]);
        top = std::max(top, at[1]);
    }
    EXPECT_NEAR(0.5 * (bottom + top), 0.5 * height, 0.06 * height);
    EXPECT_GT(top - bottom, 0.08 * height);
    EXPECT_LT(top - bottom, 0.32 * height);

    // Another scene takes the view over, with the same projection and with the other one.
    for (const bool is_same : {true, false}) {
        Window other(its.mesh);
        if (is_same) other.scene.set_options(orthographic());
        other.scene.copy_view(its.scene, true);
        other.frame_start();
        const Eigen::RowVector3d focal(its.camera()[3], its.camera()[4], its.camera()[5]);
        for (const int axis : {0, 1}) {
            const Eigen::RowVector3d beside =
                its.frame.to_mesh(focal + 0.02 * its.scene.view_axes().col(axis).transpose());
            EXPECT_NEAR(other.display(beside)[0], its.display(beside)[0], 0.01);
            EXPECT_NEAR(other.display(beside)[1], its.display(beside)[1], 0.01);
        }
    }
}

TEST(Orthographic, FlatMeshesStayFlat) {
    Window its(make_ring());
    const auto before = its.camera();
    its.scene.set_options(orthographic());
    its.frame_start();
    EXPECT_EQ(its.camera(), before);
    its.drag(200, 150, 260, 110);  // pans: a flat mesh is never turned
    EXPECT_NEAR(its.scene.view_axes()(2, 2), 1.0, 1e-12);
    its.scene.set_options({});
    its.frame_start();
    EXPECT_TRUE(its.scene.renderer()->GetActiveCamera()->GetParallelProjection());
    // And a solid after it is shown as was chosen.
    its.scene.set_options(orthographic());
    const CurvedMesh ball = make_ball();
    its.scene.set_mesh(&ball, nullptr);
    its.frame_start();
    EXPECT_TRUE(its.scene.renderer()->GetActiveCamera()->GetParallelProjection());
    its.scene.set_options({});
    EXPECT_FALSE(its.scene.renderer()->GetActiveCamera()->GetParallelProjection());
}

}  // namespace
}  // namespace curvewright
