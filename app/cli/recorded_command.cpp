#include "app/cli/recorded_command.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

namespace curvewright::cli {
namespace {

constexpr std::array<std::string_view, 9> without_effect = {"output", "json", "quiet", "threads", "trace",
                                                            "report", "csv",  "force", "help"};

std::string quoted(const std::string& word) {
    const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c >= 128 ||
               std::string_view("_-./:=,+@%").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (is_plain) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

/// Files without their folders, as reports have them: where somebody keeps files is nobody's business.
std::string recorded_value(const std::string& value) {
    std::error_code ignored;
    const std::filesystem::path path(value);
    const bool is_file = path.has_parent_path() && std::filesystem::exists(path, ignored);
    return quoted(is_file ? path.filename().string() : value);
}

/// The long name without dashes, or the name of a positional.
std::string name_of(const CLI::Option& option) {
    return option.get_lnames().empty() ? option.get_name(true) : option.get_lnames().front();
}

}  // namespace

std::string recorded_command(const CLI::App& command) {
    std::string positionals, options;
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = name_of(*option);
        if (option->count() == 0 ||
            std::find(without_effect.begin(), without_effect.end(), name) != without_effect.end())
            continue;
        const bool is_positional = option->get_lnames().empty() && option->get_snames().empty();
        const bool is_flag = option->get_items_expected_max() == 0;
        if (is_flag) {
            options += " --" + name;
            continue;
        }
        for (const std::string& value : option->results())
            (is_positional ? positionals : options) +=
                (is_positional ? " " : " --" + name + " ") + recorded_value(value);
    }
    return "curvewright-cli " + command.get_name() + positionals + options;
}

}  // namespace curvewright::cli
