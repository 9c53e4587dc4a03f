#include "core/io/animation_file.h"

#include <cmath>

#include "core/io/atomic_file.h"
#include "tests/support/decoded_animation.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

using testing::DecodedAnimation;

/// A square that goes from left to right over a ground that changes from left to right; its middle is half see-through.
std::vector<std::uint8_t> picture(int width, int height, int number, bool is_transparent) {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool is_inside = x >= 3 * number && x < 3 * number + 8 && y >= 4 && y < 12;
            const auto shade = static_cast<std::uint8_t>(2 * x);
            const std::uint8_t alpha = !is_transparent || !is_inside ? 255 : 128;
            for (const std::uint8_t value : {is_inside ? std::uint8_t{200} : shade, std::uint8_t(60), shade, alpha})
                rgba.push_back(value);
        }
    return rgba;
}

std::size_t files_in(const TemporaryFolder& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
    return count;
}

TEST(AnimationFile, lossless_films_come_back_as_they_were) {
    const TemporaryFolder folder;
    for (const bool is_transparent : {false, true}) {
        constexpr int width = 64, height = 20, count = 7;
        AnimationFile file(folder / "a.webp", {width, height, 24., true, 90.});
        for (int i = 0; i < count; ++i) file.add(picture(width, height, i, is_transparent));
        EXPECT_EQ(file.frames(), count);
        const std::uintmax_t size = file.finish();
        EXPECT_EQ(size, std::filesystem::file_size(folder / "a.webp"));
        const DecodedAnimation decoded(read_text_file(folder / "a.webp"));
        EXPECT_EQ(decoded.width, width);
        EXPECT_EQ(decoded.height, height);
        EXPECT_EQ(decoded.loops, 0u);
        ASSERT_EQ(decoded.frames.size(), std::size_t{count});
        for (int i = 0; i < count; ++i) {
            EXPECT_EQ(decoded.frames[static_cast<std::size_t>(i)], picture(width, height, i, is_transparent)) << i;
            EXPECT_EQ(decoded.ends[static_cast<std::size_t>(i)], std::lround(1000. * (i + 1) / 24.)) << i;
        }
    }
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(AnimationFile, lossy_films_are_near_and_the_nearer_the_larger) {
    const TemporaryFolder folder;
    constexpr int width = 120, height = 90;
    std::uintmax_t last_size = 0;
    double last_difference = 256.;
    for (const double quality : {5., 95.}) {
        AnimationFile file(folder / "a.webp", {width, height, 30., false, quality});
        for (int i = 0; i < 4; ++i) file.add(picture(width, height, i, false));
        const std::uintmax_t size = file.finish();
        const DecodedAnimation decoded(read_text_file(folder / "a.webp"));
        ASSERT_EQ(decoded.frames.size(), 4u);
        const double difference = DecodedAnimation::difference(decoded.frames[3], picture(width, height, 3, false));
        EXPECT_LT(difference, last_difference);
        EXPECT_GT(size, last_size);
        last_difference = difference;
        last_size = size;
    }
    EXPECT_LT(last_difference, 4.);
    EXPECT_GT(DecodedAnimation::difference(picture(width, height, 0, false), picture(width, height, 3, false)), 0.5);
}

TEST(AnimationFile, pictures_that_stand_still_keep_their_time) {
    const TemporaryFolder folder;
    AnimationFile file(folder / "a.webp", {32, 32, 10., true, 90.});
    for (const int number : {0, 0, 0, 1}) file.add(picture(32, 32, number, false));
    file.finish();
    const DecodedAnimation decoded(read_text_file(folder / "a.webp"));
    ASSERT_GE(decoded.frames.size(), 2u);
    EXPECT_EQ(decoded.ends.back(), 400);
    EXPECT_EQ(decoded.ends[decoded.ends.size() - 2], 300);
}

TEST(AnimationFile, what_is_not_finished_leaves_the_old_file) {
    const TemporaryFolder folder;
    folder.write("a.webp", "old");
    {
        AnimationFile file(folder / "a.webp", {32, 32, 10., true, 90.});
        file.add(picture(32, 32, 0, false));
    }
    std::stop_source source;
    {
        AnimationFile file(folder / "a.webp", {32, 32, 10., true, 90.});
        file.add(picture(32, 32, 0, false), {source.get_token(), {}});
        source.request_stop();
        EXPECT_THROW(file.add(picture(32, 32, 1, false), {source.get_token(), {}}), Cancelled);
        EXPECT_THROW(file.finish({source.get_token(), {}}), Cancelled);
    }
    EXPECT_EQ(read_text_file(folder / "a.webp"), "old");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(AnimationFile, what_cannot_be_written_is_told_before_the_work) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "taken.webp");
    for (const char* target : {"taken.webp", "missing/a.webp"}) {
        const std::string message = message_of<InvalidInput>([&] {
            AnimationFile(folder / target, {32, 32, 10., true, 90.});
        });
        EXPECT_NE(message.find(target), std::string::npos) << message;
    }
    EXPECT_EQ(files_in(folder), 1u);
    const AnimationOptions wrong[] = {{0, 32, 10., true, 90.},
                                      {32, 20000, 10., true, 90.},
                                      {32, 32, 0., true, 90.},
                                      {32, 32, 90., true, 90.},
                                      {32, 32, std::nan(""), true, 90.}};
    for (const AnimationOptions& options : wrong) EXPECT_THROW(AnimationFile(folder / "a.webp", options), Unsupported);
    AnimationFile file(folder / "a.webp", {32, 32, 10., true, 90.});
    EXPECT_THROW(file.add(picture(31, 32, 0, false)), InvalidInput);
}

TEST(AnimationFile, is_told_by_its_suffix) {
    EXPECT_TRUE(AnimationFile::is_animation("folder/a.WebP"));
    EXPECT_FALSE(AnimationFile::is_animation("a.webp.png"));
    EXPECT_FALSE(AnimationFile::is_animation("webp"));
}

}  // namespace
}  // namespace curvewright
