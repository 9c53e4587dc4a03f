#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include "core/base/error.h"
#include "tests/scene/image_compare.h"
#include "tests/scene/scene_meshes.h"
#include "tests/scene/scene_window.h"
#include "ui/scene/mesh_drawing.h"
#include "ui/scene/mesh_scene.h"
#include "ui/scene/offscreen.h"
#include "ui/scene/view_metrics.h"

namespace curvewright {
namespace {

TEST(Camera, TheWholeMeshIsInView) {
    for (const CurvedMesh& mesh : {make_ring(), make_ball(), make_ring(1e-6), make_ring(1e6)}) {
        Window its(mesh);
        double left = width, right = 0.0, bottom = height, top = 0.0;
        for (Index node = 0; node < mesh.topology().node_count(); ++node) {
            const auto [x, y] = its.display(mesh.coordinates().row(node));
            left = std::min(left, x);
            right = std::max(right, x);
            bottom = std::min(bottom, y);
            top = std::max(top, y);
        }
        EXPECT_GT(left, 5.0);
        EXPECT_GT(bottom, 5.0);
        EXPECT_LT(top, height - 5.0);
        EXPECT_LT(right, width - 100.0);  // the legend's strip stays free
        EXPECT_GT(top - bottom, 0.8 * height);
        const double near = its.scene.renderer()->GetActiveCamera()->GetClippingRange()[0];
        EXPECT_GT(near, 0.0);
    }
}

TEST(Camera, StaysFittedWhenTheWindowGrows) {
    Window its(make_ring());
    its.window->SetSize(1200, 900);
    its.frame_start();
    const auto [x0, y0] = its.display({0.0, 2.0, 0.0});
    EXPECT_GT(y0, 0.9 * 900.0);
    EXPECT_LT(y0, 900.0);
    // Once somebody has moved the camera, it is theirs.
    its.drag(100, 100, 160, 100);
    const auto before = its.camera();
    its.window->SetSize(800, 700);
    its.frame_start();
    EXPECT_EQ(its.camera(), before);
}

TEST(Camera, KeepsItsViewForOtherPositionsOnly) {
    Window its(make_ring());
    its.drag(100, 100, 160, 130);
    const auto before = its.camera();
    Coordinates x = its.mesh.coordinates();
    x *= 1.1;
    const CurvedMesh moved = its.mesh.with_coordinates(x);
    its.scene.set_mesh(&moved, &its.report);
    its.frame_start();
    EXPECT_EQ(its.camera(), before);
    const CurvedMesh other = make_ball();
    its.scene.set_mesh(&other, nullptr);
    its.frame_start();
    EXPECT_NE(its.camera(), before);
}

TEST(Camera, LooksAlongTheAxes) {
    Window its(make_ball());
    const std::array<std::pair<ViewDirection, std::array<double, 3>>, 6> cases{{
        {ViewDirection::plus_x, {-1, 0, 0}},
        {ViewDirection::minus_x, {1, 0, 0}},
        {ViewDirection::plus_y, {0, -1, 0}},
        {ViewDirection::minus_y, {0, 1, 0}},
        {ViewDirection::plus_z, {0, 0, -1}},
        {ViewDirection::minus_z, {0, 0, 1}},
    }};
    for (const auto& [direction, expected] : cases) {
        its.scene.look(direction);
        for (int d = 0; d < 3; ++d)
            EXPECT_NEAR(its.scene.renderer()->GetActiveCamera()->GetDirectionOfProjection()[d], expected[d], 1e-9);
    }
    its.scene.look(ViewDirection::fit);
    EXPECT_NEAR(its.scene.renderer()->GetActiveCamera()->GetDirectionOfProjection()[2], 1.0, 1e-9);
    // Flat meshes are never turned.
    Window flat(make_ring());
    flat.scene.look(ViewDirection::plus_x);
    EXPECT_NEAR(flat.scene.renderer()->GetActiveCamera()->GetDirectionOfProjection()[2], -1.0, 1e-9);
    EXPECT_TRUE(flat.scene.renderer()->GetActiveCamera()->GetParallelProjection());
}

TEST(Camera, LooksFromAnywhere) {
    Window its(make_ball());
    const auto expect_forward = [&](const Eigen::RowVector3d& to_eye) {
        its.scene.look_from(to_eye);
        for (int d = 0; d < 3; ++d)
            EXPECT_NEAR(its.scene.renderer()->GetActiveCamera()->GetDirectionOfProjection()[d], -to_eye.normalized()[d],
                        1e-9);
    };
    expect_forward({3.0, -4.0, 12.0});
    EXPECT_GT(its.scene.renderer()->GetActiveCamera()->GetViewUp()[2], 0.0);
    expect_forward({0.0, 0.0, 2.0});
    Window flat(make_ring());
    flat.scene.look_from({1.0, 0.0, 0.0});
    EXPECT_NEAR(flat.scene.renderer()->GetActiveCamera()->GetDirectionOfProjection()[2], -1.0, 1e-9);
}

TEST(Camera, PicturesFromNearAreCutFiner) {
    const auto ring = std::make_shared<const CurvedMesh>(make_ring());
    const auto points = [&](double magnification) {
        MeshDrawing drawing(ring, nullptr, {});
        drawing.options.magnification = magnification;
        drawing.make(false);
        return drawing.tessellation().edge_points().size();
    };
    EXPECT_GT(2 * points(20.0), 3 * points(1.0));
    SceneOptions far, near;
    near.magnification = 2.0;
    EXPECT_EQ(redrawing(far, near), Redrawing::all);
}

TEST(Picking, FindsTheElementUnderThePointer) {
    Window its(make_ring());
    for (Index element = 0; element < its.mesh.topology().element_count(); ++element) {
        if (element == tangled_ring_element || element == tangled_ring_element + 1)
            continue;  // it covers its neighbour
        Eigen::RowVector3d inside = its.mesh.coordinates().row(its.mesh.topology().element_nodes(element)[9]);
        const auto [x, y] = its.display(inside);
        const auto picked = its.scene.pick_element(x, y);
        ASSERT_TRUE(picked.has_value()) << element;
        if (*picked != tangled_ring_element) {
            EXPECT_EQ(*picked, element);
        }
    }
    const auto [x, y] = its.display({0.0, 0.0, 0.0});
    EXPECT_FALSE(its.scene.pick_element(x, y).has_value());
    EXPECT_FALSE(its.scene.pick_element(width - 1.0, 1.0).has_value());
}

TEST(Picking, TakesTheNearestElementOfASolid) {
    Window its(make_ball());
    its.scene.look(ViewDirection::plus_z);
    its.frame_start();
    const auto [x, y] = its.display({0.03, 0.02, 1.0});
    const auto picked = its.scene.pick_element(x, y);
    ASSERT_TRUE(picked.has_value());
    EXPECT_GT(its.mesh.element_center(*picked)[2], 0.5);
    its.scene.look(ViewDirection::minus_z);
    its.frame_start();
    const auto behind = its.scene.pick_element(x, y);
    ASSERT_TRUE(behind.has_value());
    EXPECT_LT(its.mesh.element_center(*behind)[2], -0.5);
}

TEST(Picking, DoesNotSeeHiddenElements) {
    Window its(make_ball());
    SceneOptions options;
    options.clip = ClipPlane{{0.0, 0.0, 1.0}, 0.5};
    its.scene.set_options(options);
    its.scene.look(ViewDirection::plus_z);
    its.frame_start();
    const auto [x, y] = its.display({0.1, 0.05, 0.0});
    const auto picked = its.scene.pick_element(x, y);
    ASSERT_TRUE(picked.has_value());
    EXPECT_LE(its.mesh.element_center(*picked)[2], 0.0);
    options.clip->position = 0.0;
    its.scene.set_options(options);
    its.frame_start();
    EXPECT_FALSE(its.scene.pick_element(x, y).has_value());
}

TEST(Scene, KnowsWhichElementsItDraws) {
    Window its(make_ball());
    const Index count = its.mesh.topology().element_count();
    const auto drawn = [&] {
        std::vector<bool> flags;
        for (Index element = 0; element < count; ++element) flags.push_back(its.scene.draws_element(element));
        return flags;
    };
    const std::vector<bool> whole = drawn();
    EXPECT_GT(std::count(whole.begin(), whole.end(), true), 0);
    EXPECT_GT(std::count(whole.begin(), whole.end(), false), 0);  // those inside
    SceneOptions options;
    options.clip = ClipPlane{{0.0, 0.0, 1.0}, 0.5};
    its.scene.set_options(options);
    const std::vector<bool> cut = drawn();
    bool uncovers = false;
    for (Index element = 0; element < count; ++element) {
        if (its.mesh.element_center(element)[2] > 1e-9) {
            EXPECT_FALSE(cut[element]);
        }
        uncovers = uncovers || (cut[element] && !whole[element]);
    }
    EXPECT_TRUE(uncovers);
    EXPECT_FALSE(its.scene.draws_element(count));
    its.scene.set_mesh(nullptr, nullptr);
    EXPECT_FALSE(its.scene.draws_element(0));
}

/// Every side of an outlined solid element is drawn throughout: no other side's halo hides it.
TEST(Scene, OutlineOfASolidElementIsWhole) {
    Window its(make_ball());
    MeshScene drawn;  // the same view, without the window
    drawn.set_mesh(&its.mesh, &its.report);
    for (const Index element : {30, 100, 190, 300}) {
        its.scene.focus_element(element);
        its.frame_start();
        drawn.set_highlighted_elements({element});
        drawn.copy_view(its.scene);
        const auto file = temporary_picture("outline");
        render_png(drawn, width, height, file);
        const Image image = read_image(file);
        const Eigen::MatrixX3d x = its.mesh.element_coordinates(element);  // 4 corners, then a node on each side
        for (Eigen::Index a = 0; a < 4; ++a) {
            for (Eigen::Index b = 0; b < a; ++b) {
                Eigen::Index middle = 4;
                const Eigen::RowVector3d half = 0.5 * (x.row(a) + x.row(b));
                for (Eigen::Index node = 5; node < 10; ++node)
                    if ((x.row(node) - half).norm() < (x.row(middle) - half).norm()) middle = node;
                for (double t = 0.0; t <= 1.0; t += 0.02) {
                    const Eigen::RowVector3d point =
                        (1 - t) * (1 - 2 * t) * x.row(a) + t * (2 * t - 1) * x.row(b) + 4 * t * (1 - t) * x.row(middle);
                    const auto [sx, sy] = its.display(point);
                    const unsigned char* pixel = image.pixel(static_cast<int>(sx), static_cast<int>(sy));
                    EXPECT_GT(pixel[2], pixel[0] + 80) << "element " << element << ", side " << a << b << ", " << t;
                }
            }
        }
    }
}

/// Of very many elements the region is outlined, not each of them.
TEST(Scene, OutlineOfManyElementsIsThatOfTheirRegion) {
    const CurvedMesh mesh = make_ring();
    std::vector<Index> all;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) all.push_back(element);
    const auto count_outline = [&](std::size_t most_outlined_singly) {
        const std::size_t before = std::exchange(MeshDrawing::most_outlined_singly, most_outlined_singly);
        MeshScene scene;
        scene.set_mesh(&mesh, nullptr);
        scene.set_highlighted_elements(all);
        MeshDrawing::most_outlined_singly = before;
        const auto file = temporary_picture("region");
        render_png(scene, width, height, file);
        const Image image = read_image(file);
        int count = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) count += image.pixel(x, y)[2] > image.pixel(x, y)[0] + 80 ? 1 : 0;
        return count;
    };
    const int singly = count_outline(all.size()), region = count_outline(all.size() - 1);
    EXPECT_GT(region, 500);
    EXPECT_GT(2 * singly, 3 * region);
}

TEST(Picking, FocusBringsAnElementToTheMiddle) {
    for (const CurvedMesh& mesh : {make_ring(), make_ball()}) {
        Window its(mesh);
        const Index element = 30;
        its.scene.focus_element(element);
        its.frame_start();
        double bottom = height, top = 0.0;
        for (const Eigen::MatrixX3d x = mesh.element_coordinates(element); const auto& row : x.rowwise()) {
            const auto [sx, sy] = its.display(row);
            bottom = std::min(bottom, sy);
            top = std::max(top, sy);
        }
        EXPECT_NEAR(0.5 * (bottom + top), 0.5 * height, 0.06 * height);
        EXPECT_GT(top - bottom, 0.08 * height);
        EXPECT_LT(top - bottom, 0.32 * height);
    }
}

TEST(Mouse, DragPansAFlatMesh) {
    Window its(make_ring());
    const auto before = its.display({1.5, 0.0, 0.0});
    its.drag(200, 150, 260, 110);
    const auto after = its.display({1.5, 0.0, 0.0});
    EXPECT_NEAR(after[0] - before[0], 60.0, 0.01);
    EXPECT_NEAR(after[1] - before[1], -40.0, 0.01);
}

TEST(Mouse, WheelKeepsThePointUnderThePointer) {
    for (const CurvedMesh& mesh : {make_ring(), make_ball()}) {
        Window its(mesh);
        const Eigen::RowVector3d center = bounding_box(mesh).colwise().mean();
        const auto middle = its.display(center);
        for (const auto event : {vtkCommand::MouseWheelForwardEvent, vtkCommand::MouseWheelBackwardEvent}) {
            its.at(middle[0], middle[1]);
            const double scale_before = its.camera()[9];
            const auto camera_before = its.camera();
            its.interactor->InvokeEvent(event);
            its.frame_start();
            const auto after = its.display(center);
            // The pointer stands on whole pixels.
            EXPECT_NEAR(after[0], middle[0], 1.0);
            EXPECT_NEAR(after[1], middle[1], 1.0);
            EXPECT_NE(its.camera(), camera_before);
            if (mesh.topology().dimension() == 2) {
                EXPECT_NE(its.camera()[9], scale_before);
            }
        }
    }
}

TEST(Mouse, DragTurnsASolidAndShiftPansIt) {
    Window its(make_ball());
    const auto before = its.camera();
    its.drag(200, 150, 260, 150);
    const auto turned = its.camera();
    double moved = 0.0, focal_moved = 0.0;
    for (int d = 0; d < 3; ++d) {
        moved += std::abs(turned[d] - before[d]);
        focal_moved += std::abs(turned[3 + d] - before[3 + d]);
    }
    EXPECT_GT(moved, 0.1);
    EXPECT_LT(focal_moved, 1e-9);
    const std::array<double, 2> at = its.display({0.0, 0.0, 0.0});
    its.drag(200, 150, 230, 170, true);
    EXPECT_NEAR(its.display({0.0, 0.0, 0.0})[0] - at[0], 30.0, 0.5);
    EXPECT_NEAR(its.display({0.0, 0.0, 0.0})[1] - at[1], 20.0, 0.5);
}

TEST(Mouse, KeysOfVtkDoNothing) {
    Window its(make_ball());
    bool has_exited = false;
    vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(&has_exited);
    observer->SetCallback([](vtkObject*, unsigned long, void* flag, void*) { *static_cast<bool*>(flag) = true; });
    its.interactor->AddObserver(vtkCommand::ExitEvent, observer);
    const auto before = its.camera();
    for (char key : {'q', 'e', 'w', 's', 'p', 'f', 'r', '3'}) {
        its.interactor->SetKeyEventInformation(0, 0, key, 1, nullptr);
        for (const auto event : {vtkCommand::KeyPressEvent, vtkCommand::CharEvent, vtkCommand::KeyReleaseEvent})
            its.interactor->InvokeEvent(event);
    }
    EXPECT_FALSE(has_exited);
    EXPECT_EQ(its.camera(), before);
}

TEST(Scene, CopiesAView) {
    Window its(make_ring(1e3));
    its.drag(200, 150, 260, 110);
    MeshScene other;
    Coordinates x = its.mesh.coordinates();
    x.col(0).array() += 100.0;
    const CurvedMesh moved = its.mesh.with_coordinates(x);
    other.set_mesh(&moved, nullptr);
    other.copy_view(its.scene);
    // The same view of space: in the other scene's own frame, the same point of the mesh's space is looked at.
    const auto box = bounding_box(moved);
    const WorldFrame theirs{0.5 * (box.row(0) + box.row(1)), (box.row(1) - box.row(0)).norm()};
    const double* focal = other.renderer()->GetActiveCamera()->GetFocalPoint();
    const Eigen::RowVector3d expected =
        Eigen::RowVector3d(its.camera()[3], its.camera()[4], its.camera()[5]) * its.frame.size + its.frame.origin;
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(focal[d] * theirs.size + theirs.origin[d], expected[d], 1e-6);
}

TEST(Scene, RefusesAReportOfAnotherMesh) {
    MeshScene scene;
    const CurvedMesh ring = make_ring();
    const QualityReport report = make_report(make_ball(), {});
    EXPECT_THROW(scene.set_mesh(&ring, &report), InvalidInput);
}

}  // namespace
}  // namespace curvewright
