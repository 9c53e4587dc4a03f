#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <QString>

#include "core/base/ids.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"

namespace curvewright {

// What is told to people and stays until they have read it, as data: no widgets, and nothing that can be called.

enum class NoticeSeverity {
    information,
    warning,  ///< less than was asked for, or not what one would expect
    error,    ///< what was asked for was not done
};
/// "note", "warning", "error": for lists and for those who hear the window.
QString severity_text(NoticeSeverity severity);

/// How long a notice is about what the window shows.
enum class NoticeLife {
    state,     ///< while the mesh is as it was then; comes back with undo and redo
    step,      ///< while the step that led there is done
    document,  ///< until another mesh is opened
};

/// What a notice offers to do.
enum class NoticeCommand {
    select_elements,
    select_nodes,
    slide_boundary,   ///< untangle with NoticeAction::options, which let it slide
    slide_interface,  ///< the same for an interface inside the domain
    improve,          ///< raise the quality with NoticeAction::improve
    flip,
    renumber,  ///< the elements that run against their neighbours
    open_file,
};

/// A button of a notice.
struct NoticeAction {
    NoticeCommand command = NoticeCommand::select_elements;
    std::vector<Index> items = {};  ///< the elements or nodes to select
    QString file = {};              ///< to be opened
    std::optional<GuaranteedOptions> options = {};
    std::optional<ImproveOptions> improve = {};
    bool undoes = false;  ///< the step that led to the present state is undone first
};
/// What the button says: "Select them", "Undo and let the boundary slide".
QString action_text(const NoticeAction& action);
/// What it does, one sentence.
QString action_tip(const NoticeAction& action);

/// Something to be told.
struct Notice {
    NoticeSeverity severity = NoticeSeverity::information;
    QString text;                            ///< whole sentences
    std::vector<NoticeAction> actions = {};  ///< three at most
    NoticeLife life = NoticeLife::state;
    /// What it is about, if there is to be one only: a newer one of the topic takes its place, and one that was
    /// dismissed does not come back for the same mesh and state. "" = nothing of the kind.
    QString topic = {};
};

/// A button that selects elements.
NoticeAction selecting_elements(std::vector<Index> elements);
NoticeAction selecting_nodes(std::vector<Index> nodes);
/// A button that untangles again with the boundary sliding where it was fixed; none if nothing of it was. undoes: what
/// was reached is undone first.
std::optional<NoticeAction> sliding_boundary(const GuaranteedOptions& options, bool undoes);

/// The same for interfaces inside the domain, by the names that boundary rules have for them; none if there are none.
std::optional<NoticeAction> sliding_interfaces(const GuaranteedOptions& options, const std::set<std::string>& names,
                                               bool undoes);

}  // namespace curvewright
