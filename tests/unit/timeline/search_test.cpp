#include "core/timeline/search.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/timeline/cursor.h"
#include "tests/unit/timeline/runs.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

TEST(TimelineSearch, StepsOfAllLevelsGoThereAndBack) {
    const auto recording = testing::record(testing::runs()[0]);
    const StepNumber last = recording->step_count() - 1;
    for (const StepLevel level : {StepLevel::pass, StepLevel::patch, StepLevel::iteration}) {
        std::vector<StepNumber> way{0};
        while (way.back() < last) way.push_back(step_after(*recording, way.back(), level));
        EXPECT_EQ(step_after(*recording, last, level), last);
        const std::size_t expected = level == StepLevel::pass    ? 1u + 3u + 1u
                                     : level == StepLevel::patch ? 2u + recording->patches().size() + 2u * 3u
                                                                 : recording->step_count();
        EXPECT_EQ(way.size(), expected);
        std::vector<StepNumber> back{last};
        while (back.back() > 0) back.push_back(step_before(*recording, back.back(), level));
        std::reverse(back.begin(), back.end());
        EXPECT_EQ(way, back);
        EXPECT_EQ(step_before(*recording, 0, level), 0u);
    }
}

TEST(TimelineSearch, FindsTheWorstStepAndWhenElementsBecameValid) {
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        const auto recording = testing::record(run);
        const StepNumber last = recording->step_count() - 1;
        const StepNumber worst = worst_step(*recording);
        for (const QualityPoint& point : recording->quality_points()) {
            EXPECT_LE(point.not_valid, recording->quality_at(worst).not_valid);
            if (point.not_valid < recording->quality_at(worst).not_valid) continue;
            EXPECT_GE(point.min_scaled_jacobian, recording->quality_at(worst).min_scaled_jacobian);
        }
        TimelineCursor cursor(recording);
        cursor.seek(last);
        const auto at_end = cursor.quality().elements;
        for (Index element = 0; element < run.mesh.topology().element_count(); ++element) {
            const auto since = step_of_validity(*recording, element);
            ASSERT_EQ(since.has_value(), at_end[element].validity == Validity::valid) << element;
            if (!since || *since == 0) continue;
            cursor.seek(*since);
            EXPECT_EQ(cursor.quality().elements[element].validity, Validity::valid);
            cursor.seek(*since - 1);
            if (recording->kind(*since) == StepKind::patch_certified ||
                recording->kind(*since - 1) != StepKind::patch_began)
                continue;
            EXPECT_NE(cursor.quality().elements[element].validity, Validity::valid);
        }
    }
}

TEST(TimelineSearch, StopsAtBreakpoints) {
    const testing::Run run = testing::runs()[2];
    const auto recording = testing::record(run);
    const RecordedPatch& patch = recording->patches()[recording->patches().size() / 2];
    const auto began = std::get<event::PatchBegan>(recording->read(patch.first));
    const auto has = [&](StepNumber step, Index node) {
        const auto other = std::get<event::PatchBegan>(recording->read(step));
        return std::count(other.nodes.begin(), other.nodes.end(), node) > 0;
    };
    Breakpoints at_node;
    at_node.nodes = {began.nodes[0]};
    std::vector<StepNumber> stops;
    for (auto stop = next_break(*recording, 0, at_node); stop; stop = next_break(*recording, *stop, at_node))
        stops.push_back(*stop);
    EXPECT_TRUE(std::count(stops.begin(), stops.end(), patch.first));
    std::size_t expected = 0;
    for (const RecordedPatch& each : recording->patches()) expected += has(each.first, began.nodes[0]) ? 1 : 0;
    EXPECT_EQ(stops.size(), expected);

    Breakpoints crossing;
    crossing.min_crosses_zero = true;
    const auto guaranteed = testing::record(testing::runs()[5]);
    const auto first = next_break(*guaranteed, 0, crossing);
    ASSERT_TRUE(first);
    EXPECT_GT(guaranteed->quality_at(*first).min_scaled_jacobian, 0.0f);
    EXPECT_LE(guaranteed->quality_at(*first - 1).min_scaled_jacobian, 0.0f);

    const auto tangled =
        std::find_if(guaranteed->start_quality().elements.begin(), guaranteed->start_quality().elements.end(),
                     [](const ElementQuality& quality) { return quality.validity == Validity::invalid; });
    ASSERT_NE(tangled, guaranteed->start_quality().elements.end());
    const auto element = static_cast<Index>(tangled - guaranteed->start_quality().elements.begin());
    Breakpoints at_element;
    at_element.elements = {element};
    std::vector<StepNumber> of_element;
    for (auto stop = next_break(*guaranteed, 0, at_element); stop; stop = next_break(*guaranteed, *stop, at_element))
        of_element.push_back(*stop);
    EXPECT_TRUE(std::count(of_element.begin(), of_element.end(), *step_of_validity(*guaranteed, element)));
    EXPECT_FALSE(next_break(*guaranteed, guaranteed->step_count() - 1, at_element));
    EXPECT_FALSE(next_break(*guaranteed, 0, {}));
}

TEST(TimelineSearch, APathLeadsFromThePatchsStartToTheNode) {
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        const auto recording = testing::record(run);
        TimelineCursor cursor(recording);
        int checked = 0;
        for (const RecordedPatch& patch : recording->patches()) {
            const auto began = std::get<event::PatchBegan>(recording->read(patch.first));
            const StepNumber middle = patch.first + (patch.last - patch.first) / 2;
            const auto path = node_path(*recording, began.nodes[0], middle);
            cursor.seek(middle);
            EXPECT_EQ(path.front(), began.positions[0]);
            const Index node = began.nodes[0];
            const event::Position now{cursor.coordinates()(node, 0), cursor.coordinates()(node, 1),
                                      cursor.coordinates()(node, 2)};
            EXPECT_EQ(path.back(), now) << "patch from step " << patch.first;
            if (++checked == 20) break;
        }
    }
}

}  // namespace
}  // namespace curvewright
