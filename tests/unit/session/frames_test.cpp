#include "core/session/frames.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::square_mesh;

std::shared_ptr<const Deformation> bend(double height) {
    return std::make_shared<const Deformation>(
        Deformation{OperationList{{{"bottom", Translate{{0.0, height, 0.0}}}}}, "bend.json"});
}

MotionLeg warp_leg(const CurvedMesh& mesh, const std::shared_ptr<const Deformation>& deformation) {
    return {"Warp", mesh.coordinates(), warp(mesh, apply_deformation(mesh, *deformation)).coordinates, deformation,
            WarpOptions()};
}

TEST(MotionFrames, FramesOfAWarpAreWarps) {
    const CurvedMesh mesh = square_mesh(3, 3);
    const auto deformation = bend(-0.2);
    const MotionLeg leg = warp_leg(mesh, deformation);
    MotionFrames film(mesh, {}, {leg}, 5);
    EXPECT_EQ(film.count(), 5);
    EXPECT_EQ(film.make(0, {}).mesh.coordinates(), leg.start);
    EXPECT_EQ(film.make(4, {}).mesh.coordinates(), leg.end);
    for (int i = 1; i < 4; ++i) {
        const Frame frame = film.make(i, {});
        const Coordinates expected = warp(mesh, apply_deformation(mesh, *deformation, i / 4.0)).coordinates;
        EXPECT_LT((frame.mesh.coordinates() - expected).cwiseAbs().maxCoeff(), 1e-12);
        // Certified where it is.
        ASSERT_TRUE(frame.quality);
        EXPECT_EQ(frame.quality->summary.min, assess_quality(frame.mesh).summary.min);
    }
    EXPECT_EQ(film.make(1, {}).caption, "Warp: 25 %");
    EXPECT_EQ(film.make(4, {}).caption, "Warp: 100 %");
    EXPECT_TRUE(film.straightened().empty());
}

TEST(MotionFrames, LegsTakeTheSameTimeAndMeetTheirStates) {
    const CurvedMesh mesh = square_mesh(2, 2);
    std::vector<Coordinates> x(4, mesh.coordinates());
    for (int i = 1; i < 4; ++i) x[i].row(4) += Eigen::RowVector3d(0.05 * i, -0.02 * i * i, 0.0);
    std::vector<MotionLeg> legs;
    for (int i = 0; i < 3; ++i) legs.push_back({"leg " + std::to_string(i), x[i], x[i + 1], nullptr, {}});
    MotionFrames film(mesh, {}, legs, 7);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(film.positions(2 * i, {}), x[i]);
    for (int i = 0; i < 3; ++i)
        EXPECT_LT((film.positions(2 * i + 1, {}) - 0.5 * (x[i] + x[i + 1])).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(film.make(3, {}).caption, "leg 1: 50 %");
    EXPECT_EQ(film.make(4, {}).caption, "leg 2: 0 %");
    // A number of frames that no state falls on: still within.
    MotionFrames uneven(mesh, {}, legs, 5);
    EXPECT_EQ(uneven.positions(0, {}), x[0]);
    EXPECT_EQ(uneven.positions(4, {}), x[3]);
    EXPECT_NEAR(uneven.positions(1, {})(4, 0), x[0](4, 0) + 0.05 * 0.75, 1e-15);
}

TEST(MotionFrames, ADeformationThatLeadsElsewhereGoesStraight) {
    const CurvedMesh mesh = square_mesh(2, 3);
    MotionLeg leg = warp_leg(mesh, bend(-0.2));
    leg.deformation = bend(-0.3);  // the file has been edited
    MotionFrames film(mesh, {}, {leg}, 3);
    EXPECT_LT((film.positions(1, {}) - 0.5 * (leg.start + leg.end)).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(film.straightened(), std::vector<std::string>{"Warp"});
    // So does one that does not fit at all.
    leg.deformation = std::make_shared<const Deformation>(
        Deformation{OperationList{{{"nobody", Translate{{0.0, 1.0, 0.0}}}}}, "other.json"});
    MotionFrames lost(mesh, {}, {leg}, 3);
    EXPECT_LT((lost.positions(1, {}) - 0.5 * (leg.start + leg.end)).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(lost.straightened().size(), 1u);
}

TEST(MotionFrames, TheOrientationIsThatOfTheWholeFilm) {
    // The mesh is turned inside out on its way: not valid at the end, as nothing was renumbered.
    const CurvedMesh mesh = square_mesh(2, 2);
    Coordinates mirrored = mesh.coordinates();
    mirrored.col(0) = -mirrored.col(0);
    MotionFrames film(mesh, assess_quality(mesh).orientation_sign,
                      {{"Mirror", mesh.coordinates(), mirrored, nullptr, {}}}, 3);
    EXPECT_EQ(film.make(0, {}).quality->summary.invalid, 0);
    EXPECT_EQ(film.make(2, {}).quality->summary.valid, 0);
}

TEST(MotionFrames, RefusesWhatIsNoFilm) {
    const CurvedMesh mesh = square_mesh(2, 2);
    const MotionLeg leg{"", mesh.coordinates(), mesh.coordinates(), nullptr, {}};
    EXPECT_THROW(MotionFrames(mesh, {}, {leg}, 1), InvalidInput);
    EXPECT_THROW(MotionFrames(mesh, {}, {}, 5), InvalidInput);
    EXPECT_THROW(MotionFrames(mesh, {}, {{"", Coordinates(3, 3), mesh.coordinates(), nullptr, {}}}, 5), InvalidInput);
    std::stop_source stop;
    stop.request_stop();
    MotionFrames film(mesh, {}, {leg}, 3);
    EXPECT_THROW(film.make(1, {stop.get_token(), {}}), Cancelled);
}

TEST(MotionFrames, ThereAndBackIsALoop) {
    std::vector<int> frames;
    for (int i = 0; i < 2 * (4 - 1); ++i) frames.push_back(there_and_back(i, 4));
    EXPECT_EQ(frames, (std::vector<int>{0, 1, 2, 3, 2, 1}));
}

}  // namespace
}  // namespace curvewright
