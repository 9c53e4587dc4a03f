#include "core/report/report_files.h"

#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/report/report_json.h"

namespace curvewright {
namespace {

namespace fs = std::filesystem;

bool is_same(const fs::path& a, const fs::path& b) {
    std::error_code error;
    return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
}

/// "out/report/" is the same folder as "out/report".
fs::path without_slash(const fs::path& folder) {
    return folder.has_filename() || !folder.has_parent_path() ? folder : folder.parent_path();
}

}  // namespace

void check_report_folder(const fs::path& given, const std::vector<fs::path>& others) {
    const fs::path folder = without_slash(given);
    const std::string name = folder.string();
    if (name.empty()) throw InvalidInput("The folder of the report has no name; a folder was expected.");
    std::error_code error;
    const bool is_there = fs::is_directory(folder, error);
    const fs::file_type type = fs::symlink_status(folder, error).type();
    if (type == fs::file_type::none)
        throw InvalidInput(name, 0, fmt::format("the report cannot be written there ({}).", error.message()));
    if (!is_there && type != fs::file_type::not_found)
        throw InvalidInput(name, 0, "the report needs a folder, and this is something else.");
    const fs::path parent = is_there ? folder : folder.has_parent_path() ? folder.parent_path() : fs::path(".");
    if (!fs::is_directory(parent, error))
        throw InvalidInput(name, 0,
                           fmt::format("there is no folder {} to make the report's folder in.", parent.string()));
    if (::access(parent.c_str(), W_OK | X_OK) != 0)
        throw InvalidInput(name, 0, "the report cannot be written there; the folder is not writable.");
    for (const char* file : {report_html_name, report_json_name}) {
        if (fs::is_directory(folder / file, error))
            throw InvalidInput((folder / file).string(), 0, "there is a folder of that name; the report needs a file.");
        for (const fs::path& other : others)
            if (is_same(folder / file, other))
                throw InvalidInput(other.string(), 0, "the report has a file of that name; another name is needed.");
    }
    for (const fs::path& other : others)
        if (is_same(folder, other))
            throw InvalidInput(other.string(), 0, "this cannot be a file and the report's folder at the same time.");
}

ReportFiles::ReportFiles(const fs::path& folder, const RunReport& report, const ReportPictures& pictures,
                         const ReportColors& colors)
    : folder_(without_slash(folder)) {
    check_report_folder(folder_);
    std::error_code error;
    is_made_ = fs::create_directory(folder_, error);
    if (error) throw InvalidInput(folder_.string(), 0, fmt::format("the folder cannot be made ({}).", error.message()));
    try {
        const std::pair<const char*, std::string> contents[] = {{report_html_name, to_html(report, pictures, colors)},
                                                                {report_json_name, to_json(report, pictures)}};
        for (const auto& [name, text] : contents) {
            files_.push_back(std::make_unique<AtomicFile>(folder_ / name));
            std::ofstream stream(files_.back()->path(), std::ios::binary);
            stream.write(text.data(), static_cast<std::streamsize>(text.size()));
            stream.close();
            if (!stream)
                throw InvalidInput((folder_ / name).string(), 0,
                                   "the report could not be written completely (is the disk full?).");
        }
    } catch (...) {
        files_.clear();
        if (is_made_) fs::remove(folder_, error);
        throw;
    }
}

ReportFiles::~ReportFiles() {
    files_.clear();
    std::error_code ignored;
    if (is_made_ && !is_committed_) fs::remove(folder_, ignored);  // not if there is something in it
}

void ReportFiles::commit() {
    for (const auto& file : files_) file->commit();
    is_committed_ = true;
}

}  // namespace curvewright
