#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "tests/scene/image_compare.h"
#include "tests/scene/scene_window.h"
#include "ui/scene/label_spacing.h"
#include "ui/scene/offscreen.h"
#include "ui/scene/text_font.h"

namespace curvewright {
namespace {

SceneOptions numbers(bool of_nodes, bool of_elements) {
    SceneOptions options;
    options.show_node_numbers = of_nodes;
    options.show_element_numbers = of_elements;
    return options;
}

using Shown = std::vector<MeshScene::ShownNumber>;

std::array<double, 2> middle(const MeshScene::ShownNumber& number) {
    return {0.5 * (number.box[0] + number.box[2]), 0.5 * (number.box[1] + number.box[3])};
}

void expect_apart(const Shown& shown, double right) {
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto& a = shown[i].box;
        EXPECT_GE(a[0], 0);
        EXPECT_GE(a[1], 0);
        EXPECT_LE(a[2], right);
        EXPECT_LE(a[3], height);
        for (std::size_t j = 0; j < i; ++j) {
            const auto& b = shown[j].box;
            EXPECT_TRUE(a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1])
                << shown[i].tag << " is over " << shown[j].tag;
        }
    }
}

TEST(Numbers, AreTheTagsOfTheFileAtTheirPlaces) {
    Window its(make_ring());
    its.scene.set_options(numbers(true, true));
    its.frame_start();
    const Shown shown = its.scene.shown_numbers();
    std::set<std::int64_t> elements;
    int nodes = 0;
    for (const auto& number : shown) {
        const auto at = middle(number);
        if (number.is_element) {
            elements.insert(number.tag);
            const auto element = its.mesh.topology().find_element({number.tag});
            ASSERT_TRUE(element.has_value());
            if (*element < tangled_ring_element - 1 || *element > tangled_ring_element + 2) {
                EXPECT_EQ(its.scene.pick_element(at[0], at[1]), *element);
            }
        } else {
            ++nodes;
            const auto node = its.mesh.topology().find_node({number.tag});
            ASSERT_TRUE(node.has_value());
            const auto place = its.display(its.mesh.coordinates().row(*node));
            EXPECT_LT(std::hypot(at[0] - place[0], at[1] - place[1]), 26.0);
        }
    }
    EXPECT_GT(elements.size(), 30u);  // nearly all of the 36
    EXPECT_GT(nodes, 40);
    expect_apart(shown, width - 90.0);  // the legend's strip stays free
    // Only those asked for.
    its.scene.set_options(numbers(true, false));
    its.frame_start();
    for (const auto& number : its.scene.shown_numbers()) EXPECT_FALSE(number.is_element);
    its.scene.set_options({});
    its.frame_start();
    EXPECT_TRUE(its.scene.shown_numbers().empty());
}

TEST(Numbers, HiddenOnesAreNotShownAndTheNearestGoFirst) {
    for (const bool is_orthographic : {false, true}) {
        Window its(make_ball());
        SceneOptions options = numbers(true, true);
        options.is_orthographic = is_orthographic;
        its.scene.set_options(options);
        its.scene.look(ViewDirection::plus_z);
        its.frame_start();
        const Shown shown = its.scene.shown_numbers();
        EXPECT_GT(shown.size(), 30u);
        expect_apart(shown, width);
        for (const auto& number : shown) {
            EXPECT_TRUE(number.box[0] > 80 || number.box[1] > 80);  // the axes' corner stays free
            if (number.is_element) {
                EXPECT_GT(its.mesh.element_center(*its.mesh.topology().find_element({number.tag}))[2], -0.1);
            } else {
                EXPECT_GT(its.mesh.coordinates()(*its.mesh.topology().find_node({number.tag}), 2), -0.1);
            }
        }
        // The node at the pole is the nearest of all.
        Index pole = 0;
        for (Index node = 0; node < its.mesh.topology().node_count(); ++node)
            if (its.mesh.coordinates()(node, 2) > its.mesh.coordinates()(pole, 2)) pole = node;
        its.scene.set_options([&] {
            SceneOptions only = numbers(true, false);
            only.is_orthographic = is_orthographic;
            return only;
        }());
        its.frame_start();
        EXPECT_EQ(its.scene.shown_numbers().front().tag, its.mesh.topology().node_tag(pole).value);
        // Seen from below other ones are shown.
        its.scene.look(ViewDirection::minus_z);
        its.frame_start();
        for (const auto& number : its.scene.shown_numbers())
            EXPECT_LT(its.mesh.coordinates()(*its.mesh.topology().find_node({number.tag}), 2), 0.1);
    }
}

TEST(Numbers, StandOnTheSectionAndNotBeyondIt) {
    Window its(make_ball());
    SceneOptions options = numbers(true, true);
    options.clip = ClipPlane{{0.0, 0.0, 1.0}, 0.55, ClipStyle::cut};
    its.scene.set_options(options);
    its.scene.look(ViewDirection::plus_z);
    its.frame_start();
    int on_section = 0, at_its_place = 0;  // the number of a sliver is a pixel beside it
    for (const auto& number : its.scene.shown_numbers()) {
        const auto at = middle(number);
        if (!number.is_element) {
            EXPECT_LT(its.mesh.coordinates()(*its.mesh.topology().find_node({number.tag}), 2), 0.1 + 1e-6);
            continue;
        }
        at_its_place += its.scene.pick_element(at[0], at[1]) == its.mesh.topology().find_element({number.tag});
        ++on_section;
    }
    EXPECT_GT(on_section, 20);
    EXPECT_GE(at_its_place, on_section - 3);
}

TEST(Numbers, AreFewerWithRoomAroundThemWhereThereAreMany) {
    Window its(make_ring());
    its.scene.set_options(numbers(true, false));
    its.scene.look(ViewDirection::fit);
    double share = 1.0;  // of the nodes in the view, at the last size
    std::vector<double> shares;
    for (int step = 0; step < 4; ++step) {
        its.frame_start();
        const Shown shown = its.scene.shown_numbers();
        ASSERT_FALSE(shown.empty());
        expect_apart(shown, width);
        shares.push_back(double(shown.size()) / double(its.mesh.topology().node_count()));
        EXPECT_LE(shares.back(), share + 1e-9);
        share = shares.back();
        if (step == 3) {
            // All on the same side of their nodes, and apart by more than a digit.
            for (std::size_t i = 0; i < shown.size(); ++i) {
                const auto node = its.mesh.topology().find_node({shown[i].tag});
                const auto place = its.display(its.mesh.coordinates().row(*node));
                EXPECT_GE(shown[i].box[0], place[0] - 1.0);
                EXPECT_GE(shown[i].box[1], place[1] - 1.0);
                for (std::size_t j = 0; j < i; ++j) {
                    const auto &a = shown[i].box, &b = shown[j].box;
                    EXPECT_GE(std::max({a[0] - b[2], b[0] - a[2], a[1] - b[3], b[1] - a[3]}), 8);
                }
            }
        }
        its.at(0.5 * width, 0.5 * height);
        for (int notch = 0; notch < 3; ++notch) its.interactor->InvokeEvent(vtkCommand::MouseWheelBackwardEvent);
    }
    EXPECT_LT(shares.back(), 0.3 * shares.front());
}

TEST(Numbers, FollowAMotion) {
    Window its(make_ring());
    its.scene.set_options(numbers(true, false));
    its.frame_start();
    Coordinates x = its.mesh.coordinates();
    x.col(0).array() -= 0.5;
    its.scene.show_frame(x, nullptr);
    its.frame_start();
    const Shown shown = its.scene.shown_numbers();
    EXPECT_GT(shown.size(), 30u);
    for (const auto& number : shown) {
        const auto place = its.display(x.row(*its.mesh.topology().find_node({number.tag})));
        const auto at = middle(number);
        EXPECT_LT(std::hypot(at[0] - place[0], at[1] - place[1]), 26.0);
    }
}

TEST(Numbers, AreLegibleOnEveryGroundAndAtEverySize) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element});
    for (const bool is_dark : {false, true})
        for (const double ratio : {1.0, 2.0}) {
            MeshScene scene;
            SceneOptions options = numbers(true, true);
            if (is_dark) {
                options.background = {0.12, 0.13, 0.15};
                options.foreground = {0.92, 0.92, 0.92};
            }
            options.pixel_ratio = ratio;
            scene.set_options(options);
            scene.set_mesh(&mesh, &report);
            const auto file = temporary_picture("numbers");
            const int wide = static_cast<int>(width * ratio), high = static_cast<int>(height * ratio);
            render_png(scene, wide, high, file);
            const Image image = read_image(file);
            // The picture is drawn twice as large and averaged.
            int legible = 0;
            double tall = 0.0;
            const Shown shown = scene.shown_numbers();
            for (const auto& number : shown) {
                double darkest = 255.0, lightest = 0.0;
                for (int y = number.box[1] / 2; y < number.box[3] / 2; ++y)
                    for (int x = number.box[0] / 2; x < number.box[2] / 2; ++x) {
                        const double grey = 0.5 * (image.pixel(x, y)[0] + image.pixel(x, y)[1]);
                        darkest = std::min(darkest, grey);
                        lightest = std::max(lightest, grey);
                    }
                legible += lightest - darkest > 90.0;
                tall = std::max(tall, 0.5 * (number.box[3] - number.box[1]));
            }
            EXPECT_GT(shown.size(), 50u);
            EXPECT_EQ(legible, static_cast<int>(shown.size())) << is_dark << ratio;
            EXPECT_NEAR(tall / ratio, 12.5, 3.0);
        }
}

TEST(Text, IsWholeInTheFontOfTheWindowAndInVtks) {
    const CurvedMesh mesh = make_ring();
    const QualityReport report = make_report(mesh, {tangled_ring_element});
    for (const TextFont& font : {TextFont(), find_text_font()}) {
        MeshScene scene;
        SceneOptions options = numbers(true, true);
        options.font = font;
        scene.set_options(options);
        scene.set_mesh(&mesh, &report);
        const auto file = temporary_picture("font");
        render_png(scene, width, height, file);
        const Image image = read_image(file);
        // Dark pixels of the legend, right of its bar: there are some, and none at the picture's edge.
        int ink = 0;
        for (int y = 0; y < height; ++y)
            for (int x = width - 80; x < width; ++x) {
                const auto* pixel = image.pixel(x, y);
                if (pixel[0] > 150 || pixel[1] > 150 || pixel[2] > 150) continue;
                ++ink;
                EXPECT_LT(x, width - 2) << font.regular << " " << y;
            }
        EXPECT_GT(ink, 200) << font.regular;
    }
    // Both files are there, or neither is asked for.
    const TextFont found = find_text_font();
    EXPECT_EQ(found.regular.empty(), found.bold.empty());
    if (!found.regular.empty()) {
        EXPECT_TRUE(std::filesystem::is_regular_file(found.regular) && std::filesystem::is_regular_file(found.bold));
    }
}

TEST(LabelSpacing, TextsGoApartAsFarAsTheyMust) {
    // Two side by side that overlap by 4 of 20, one far away, two in the same place.
    std::vector<LabelBox> boxes{{0, 0, 20, 10}, {16, 3, 20, 10}, {200, 0, 20, 10}, {0, 100, 20, 10}, {0, 100, 20, 10}};
    keep_apart(boxes);
    EXPECT_NEAR(boxes[1].x - boxes[0].x, 20.0, 1e-9);
    EXPECT_NEAR(boxes[0].x + boxes[1].x, 16.0, 1e-9);
    EXPECT_EQ(boxes[0].y, 0.0);
    EXPECT_EQ(boxes[1].y, 3.0);
    EXPECT_EQ(boxes[2].x, 200.0);
    EXPECT_NEAR(boxes[4].y - boxes[3].y, 10.0, 1e-9);
    // A crowd comes apart as well.
    std::vector<LabelBox> crowd;
    for (int i = 0; i < 4; ++i) crowd.push_back({3.0 * i, 2.0 * (i % 2), 20, 10});
    keep_apart(crowd);
    for (std::size_t i = 0; i < crowd.size(); ++i)
        for (std::size_t k = i + 1; k < crowd.size(); ++k)
            EXPECT_TRUE(std::abs(crowd[i].x - crowd[k].x) > 19.0 || std::abs(crowd[i].y - crowd[k].y) > 9.0);
}

}  // namespace
}  // namespace curvewright
