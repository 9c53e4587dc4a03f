#include "core/timeline/recording.h"

#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/timeline/cursor.h"
#include "tests/unit/timeline/runs.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

/// Keeps all coordinates after every event, by itself: what a cursor has to reach.
class Witness : public UntangleObserver {
  public:
    explicit Witness(Recorder& recorder) : recorder_(recorder) {}

    void on_event(const UntangleEvent& event) override {
        recorder_.on_event(event);
        if (const auto* started = std::get_if<event::Started>(&event)) x_ = started->mesh->coordinates();
        if (const auto* began = std::get_if<event::PatchBegan>(&event)) {
            nodes_ = began->nodes;
            EXPECT_EQ(began->positions, at(nodes_)) << "a patch does not begin where its nodes are";
        }
        if (const auto* step = std::get_if<event::SimplexStep>(&event))
            x_.row(step->node).head<2>() << step->simplex[0][0], step->simplex[0][1];
        if (const auto* step = std::get_if<event::BfgsStep>(&event)) place(nodes_, step->positions);
        if (const auto* step = std::get_if<event::EnergyStep>(&event)) place(nodes_, step->positions);
        if (const auto* ended = std::get_if<event::PatchEnded>(&event)) place(ended->nodes, ended->positions);
        if (const auto* moved = std::get_if<event::FaceNodesMoved>(&event)) place(moved->nodes, moved->positions);
        if (const auto* placed = std::get_if<event::NodesPlaced>(&event)) place(placed->nodes, placed->positions);
        if (const auto* pass = std::get_if<event::PassEnded>(&event)) {
            EXPECT_EQ(x_, *pass->coordinates) << "a pass ends elsewhere than its events say";
            minima.push_back({states.size(), pass->min_scaled_jacobian, pass->invalid + pass->undecided});
        }
        states.push_back(x_);
    }

    struct Minimum {
        std::size_t step;
        double least;
        Index not_valid;
    };
    std::vector<Coordinates> states;
    std::vector<Minimum> minima;

  private:
    std::vector<event::Position> at(const std::vector<Index>& nodes) const {
        std::vector<event::Position> result;
        for (const Index node : nodes) result.push_back({x_(node, 0), x_(node, 1), x_(node, 2)});
        return result;
    }
    void place(const std::vector<Index>& nodes, const std::vector<event::Position>& positions) {
        for (std::size_t i = 0; i < positions.size(); ++i)
            x_.row(nodes[i]) << positions[i][0], positions[i][1], positions[i][2];
    }

    Recorder& recorder_;
    Coordinates x_;
    std::vector<Index> nodes_;
};

bool is_exact(StepKind kind) {
    return kind != StepKind::energy_step && kind != StepKind::patch_certified;
}

TEST(Recording, LeadsToEveryStateOfEveryMethodInAnyOrder) {
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        // Nearly everything in the temporary file.
        Recorder recorder({0});
        Witness witness(recorder);
        const Coordinates result = testing::untangle(run, &witness);
        EXPECT_EQ(result, testing::untangle(run, nullptr)) << "observing changed the result";
        EXPECT_EQ(witness.states.back(), result) << "the events lead elsewhere";
        const auto recording = recorder.finish();
        EXPECT_TRUE(recorder.problem().empty());
        ASSERT_EQ(recording->step_count(), witness.states.size());
        ASSERT_GT(recording->step_count(), 30u);
        EXPECT_FALSE(recording->patches().empty());

        TimelineCursor cursor(recording);
        QualityOptions options;
        options.orientation_sign = recording->start_quality().orientation_sign;
        std::mt19937 random(7);
        std::uniform_int_distribution<StepNumber> anywhere(0, recording->step_count() - 1);
        std::vector<StepNumber> way;
        for (int i = 0; i < 60; ++i) way.push_back(anywhere(random));
        const StepNumber middle = recording->step_count() / 2;
        for (StepNumber step = middle; step < std::min(middle + 40, recording->step_count()); ++step)
            way.push_back(step);
        for (StepNumber back = 0; back < 40 && back <= middle; ++back) way.push_back(middle - back);
        way.push_back(recording->step_count() - 1);
        way.push_back(0);
        const double size = run.mesh.coordinates().cwiseAbs().maxCoeff();
        for (const StepNumber step : way) {
            cursor.seek(step);
            // Between two energy steps a patch is shown where the last one had it, also when it is judged.
            const Coordinates& expected = witness.states[step];
            if (is_exact(recording->kind(step))) {
                ASSERT_EQ(cursor.coordinates(), expected) << "step " << step;
            } else
                ASSERT_LT((cursor.coordinates() - expected).cwiseAbs().maxCoeff(), 1e-7 * size) << "step " << step;
            const QualityReport fresh = assess_quality(run.mesh.with_coordinates(cursor.coordinates()), options);
            ASSERT_EQ(cursor.quality().summary.min, fresh.summary.min) << "step " << step;
            ASSERT_EQ(cursor.quality().summary.mean, fresh.summary.mean) << "step " << step;
            ASSERT_EQ(cursor.quality().summary.valid, fresh.summary.valid) << "step " << step;
            EXPECT_EQ(cursor.patch().has_value(), recording->patch_of(step).has_value());
        }
        for (const Witness::Minimum& minimum : witness.minima) {
            const QualityPoint& point = recording->quality_at(static_cast<StepNumber>(minimum.step));
            EXPECT_EQ(point.min_scaled_jacobian, static_cast<float>(minimum.least));
            EXPECT_EQ(point.not_valid, minimum.not_valid);
        }
    }
}

TEST(Recording, GivesBackTheEvents) {
    struct Keeper : UntangleObserver {
        explicit Keeper(Recorder& r) : recorder(r) {}
        void on_event(const UntangleEvent& event) override {
            recorder.on_event(event);
            events.push_back(event);
        }
        Recorder& recorder;
        std::vector<UntangleEvent> events;
    };
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        Recorder recorder;
        Keeper keeper(recorder);
        testing::untangle(run, &keeper);
        const auto recording = recorder.finish();
        ASSERT_EQ(recording->step_count(), keeper.events.size());
        for (StepNumber step = 0; step < recording->step_count(); ++step) {
            const StepEvent read = recording->read(step);
            ASSERT_EQ(read.index(), keeper.events[step].index());
            ASSERT_EQ(kind_of(read), recording->kind(step));
            if (const auto* e = std::get_if<event::PatchBegan>(&keeper.events[step])) {
                EXPECT_EQ(std::get<event::PatchBegan>(read).nodes, e->nodes);
                EXPECT_EQ(std::get<event::PatchBegan>(read).elements, e->elements);
                EXPECT_EQ(std::get<event::PatchBegan>(read).positions, e->positions);
            } else if (const auto* simplex_step = std::get_if<event::SimplexStep>(&keeper.events[step])) {
                const auto& simplex = std::get<event::SimplexStep>(read);
                EXPECT_EQ(simplex.node, simplex_step->node);
                EXPECT_EQ(simplex.simplex, simplex_step->simplex);
                EXPECT_EQ(simplex.angles, simplex_step->angles);
                EXPECT_EQ(simplex.angle_term, simplex_step->angle_term);
                EXPECT_NEAR(simplex_step->angle_term + simplex_step->displacement_term, simplex_step->objective[0],
                            1e-12 * simplex_step->objective[0]);
            } else if (const auto* bfgs = std::get_if<event::BfgsStep>(&keeper.events[step])) {
                EXPECT_EQ(std::get<event::BfgsStep>(read).positions, bfgs->positions);
                EXPECT_EQ(std::get<event::BfgsStep>(read).gradient_norm, bfgs->gradient_norm);
            } else if (const auto* energy = std::get_if<event::EnergyStep>(&keeper.events[step])) {
                EXPECT_EQ(std::get<event::EnergyStep>(read).eps, energy->eps);
                EXPECT_EQ(std::get<event::EnergyStep>(read).least_determinant, energy->least_determinant);
            } else if (const auto* certified = std::get_if<event::PatchCertified>(&keeper.events[step])) {
                EXPECT_EQ(std::get<event::PatchCertified>(read).worst_point, certified->worst_point);
            } else if (const auto* ended = std::get_if<event::PatchEnded>(&keeper.events[step])) {
                EXPECT_EQ(std::get<event::PatchEnded>(read).positions, ended->positions);
                EXPECT_EQ(std::get<event::PatchEnded>(read).beta, ended->beta);
            } else if (const auto* pass = std::get_if<event::PassEnded>(&keeper.events[step])) {
                EXPECT_EQ(std::get<event::PassEnded>(read).relative_change, pass->relative_change);
            } else if (const auto* finished = std::get_if<event::Finished>(&keeper.events[step])) {
                EXPECT_EQ(std::get<event::Finished>(read).reason, finished->reason);
            }
        }
    }
}

TEST(Recording, KnowsItsPassesAndPatches) {
    const auto recording = testing::record(testing::runs()[0]);
    ASSERT_EQ(recording->passes().size(), 3u);
    StepNumber last = 0;
    for (const RecordedPass& pass : recording->passes()) {
        EXPECT_EQ(recording->kind(pass.first), StepKind::pass_began);
        EXPECT_EQ(recording->kind(pass.last), StepKind::pass_ended);
        EXPECT_GT(pass.first, last);
        last = pass.last;
    }
    std::uint32_t number = 0, in_pass = 0;
    for (const RecordedPatch& patch : recording->patches()) {
        EXPECT_EQ(recording->kind(patch.first), StepKind::patch_began);
        EXPECT_EQ(recording->kind(patch.last), StepKind::patch_ended);
        if (patch.pass != in_pass) number = 0;
        in_pass = patch.pass;
        EXPECT_EQ(patch.number, ++number);
        EXPECT_EQ(recording->pass_of(patch.first), patch.pass);
    }
    EXPECT_FALSE(recording->patch_of(0));
    EXPECT_FALSE(recording->pass_of(recording->step_count() - 1));
}

TEST(Recording, HoldsAWarpInIncrements) {
    const CurvedMesh mesh = testing::square_mesh(3, 3);
    Recorder recorder;
    recorder.begin_warp(mesh);
    Coordinates x = mesh.coordinates(), accepted = x;
    const Index inner = mesh.topology().interior_nodes()[0];
    x(inner, 0) += 0.01;
    accepted = x;
    recorder.add_increment({0.5, true, 0.9, 0, 0}, x);
    x(inner, 0) += 5.0;
    recorder.add_increment({1.0, false, -1.0, 1, 0}, x);
    recorder.end_warp(accepted, StopReason::no_progress);
    const auto recording = recorder.finish();
    ASSERT_EQ(recording->step_count(), 6u);  // start, pass, two increments, put back, end
    TimelineCursor cursor(recording);
    cursor.seek(3);
    EXPECT_EQ(cursor.coordinates(), x);
    EXPECT_GT(cursor.quality().summary.invalid, 0);
    EXPECT_EQ(std::get<WarpIncrement>(recording->read(3)).fraction, 1.0);
    cursor.seek(5);
    EXPECT_EQ(cursor.coordinates(), accepted);
    cursor.seek(0);
    EXPECT_EQ(cursor.coordinates(), mesh.coordinates());
}

TEST(Recording, MemoryStaysWithinItsLimit) {
    const testing::Run run = testing::runs()[5];  // guaranteed: the most bytes per step
    const auto recording = testing::record(run, 0);
    EXPECT_GT(recording->size(), 4u * StepStore::block_size);
    TimelineCursor cursor(recording);
    for (StepNumber step = 0; step < recording->step_count(); step += 7) cursor.seek(step);
    EXPECT_LT(recording->memory(), 2 * 40 * StepStore::block_size + recording->size() / 4);
}

TEST(TimelineCursor, ACancelledSeekIsMadeGoodByTheNext) {
    const auto recording = testing::record(testing::runs()[0]);
    TimelineCursor cursor(recording), other(recording);
    std::stop_source source;
    source.request_stop();
    const StepNumber last = recording->step_count() - 1;
    EXPECT_THROW(cursor.seek(last, {source.get_token(), {}}), Cancelled);
    cursor.seek(last);
    other.seek(last);
    EXPECT_EQ(cursor.coordinates(), other.coordinates());
    EXPECT_EQ(cursor.quality().summary.min, other.quality().summary.min);
    EXPECT_EQ(cursor.quality().summary.mean, other.quality().summary.mean);
}

}  // namespace
}  // namespace curvewright
