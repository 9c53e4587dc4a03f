#include "ui/jobs/window_provenance.h"

#include <filesystem>
#include <variant>

#include <QCoreApplication>

namespace curvewright {
namespace {

/// What a session calls them.
struct ActionName {
    const char* operator()(const DeformAction&) const { return "deform"; }
    const char* operator()(const WarpAction&) const { return "warp"; }
    const char* operator()(const UntangleAction&) const { return "untangle"; }
    const char* operator()(const ImproveAction&) const { return "improve"; }
    const char* operator()(const FlipAction&) const { return "flip"; }
    const char* operator()(const ReorientAction&) const { return "reorient"; }
    const char* operator()(const DragAction&) const { return "drag"; }
    const char* operator()(const PlaceAction&) const { return "place"; }
    template <class Other>
    const char* operator()(const Other&) const {
        return "step";
    }
};

}  // namespace

Provenance window_provenance(const std::vector<Action>& way, const std::string& sha256) {
    Provenance provenance;
    provenance.version = QCoreApplication::applicationVersion().toStdString();
    provenance.command = "curvewright (window)";
    for (const Action& action : way) {
        if (const auto* open = std::get_if<OpenAction>(&action)) {
            provenance.input = std::filesystem::path(open->mesh).filename().string();
            continue;
        }
        provenance.command += provenance.command.back() == ')' ? ": " : ", ";
        provenance.command += std::visit(ActionName(), action);
    }
    if (!provenance.input.empty()) provenance.input_sha256 = sha256;
    return provenance;
}

}  // namespace curvewright
