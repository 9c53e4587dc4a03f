#include "ui/document/notice.h"

#include <algorithm>

#include <QCoreApplication>

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("Notice", text);
}

}  // namespace

QString severity_text(NoticeSeverity severity) {
    switch (severity) {
        case NoticeSeverity::information:
            return tr("note");
        case NoticeSeverity::warning:
            return tr("warning");
        case NoticeSeverity::error:
            return tr("error");
    }
    return {};
}

QString action_text(const NoticeAction& action) {
    switch (action.command) {
        case NoticeCommand::select_elements:
        case NoticeCommand::select_nodes:
            return action.items.size() == 1 ? tr("Select it") : tr("Select them");
        case NoticeCommand::slide_boundary:
            return action.undoes ? tr("Undo and let the boundary slide") : tr("Let the boundary slide");
        case NoticeCommand::slide_interface:
            return action.undoes ? tr("Undo and let the interface slide") : tr("Let the interface slide");
        case NoticeCommand::improve:
            return tr("Improve it");
        case NoticeCommand::flip:
            return tr("Flip");
        case NoticeCommand::renumber:
            return tr("Renumber them");
        case NoticeCommand::open_file:
            return tr("Open");
    }
    return {};
}

QString action_tip(const NoticeAction& action) {
    switch (action.command) {
        case NoticeCommand::select_elements:
            return tr("Selects the elements and brings them into view.");
        case NoticeCommand::select_nodes:
            return tr("Selects the nodes and brings them into view.");
        case NoticeCommand::slide_boundary:
            return tr("Untangles again with the boundary sliding along itself; corners and feature edges stay.");
        case NoticeCommand::slide_interface:
            return tr("Untangles again with the interface inside the domain sliding along itself; its shape stays.");
        case NoticeCommand::improve:
            return tr("Raises the quality of the worst elements, as a step that can be undone.");
        case NoticeCommand::renumber:
            return tr("Numbers them as their neighbours are, as a step that can be undone; nothing moves.");
        case NoticeCommand::flip:
            return tr("Numbers every element the other way round, as a step that can be undone.");
        case NoticeCommand::open_file:
            return tr("Opens the file with the program that the system has for it.");
    }
    return {};
}

NoticeAction selecting_elements(std::vector<Index> elements) {
    std::sort(elements.begin(), elements.end());
    return {NoticeCommand::select_elements, std::move(elements)};
}

NoticeAction selecting_nodes(std::vector<Index> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return {NoticeCommand::select_nodes, std::move(nodes)};
}

std::optional<NoticeAction> sliding_boundary(const GuaranteedOptions& options, bool undoes) {
    const auto is_fixed = [](const BoundaryRules::Rule& rule) { return rule.mode == BoundaryMode::fixed; };
    BoundaryRules rules = options.boundary;
    if (rules.otherwise != BoundaryMode::fixed && std::none_of(rules.groups.begin(), rules.groups.end(), is_fixed))
        return std::nullopt;
    if (rules.otherwise == BoundaryMode::fixed) rules.otherwise = BoundaryMode::slide;
    // What is left are the parts that do something else than the rest.
    for (BoundaryRules::Rule& rule : rules.groups)
        if (is_fixed(rule)) rule.mode = BoundaryMode::slide;
    std::erase_if(rules.groups, [&](const BoundaryRules::Rule& rule) { return rule.mode == rules.otherwise; });
    NoticeAction action{NoticeCommand::slide_boundary};
    action.options = options;
    action.options->boundary = rules;
    action.undoes = undoes;
    return action;
}

std::optional<NoticeAction> sliding_interfaces(const GuaranteedOptions& options, const std::set<std::string>& names,
                                               bool undoes) {
    if (names.empty()) return std::nullopt;
    NoticeAction action{NoticeCommand::slide_interface};
    action.options = options;
    action.undoes = undoes;
    std::vector<BoundaryRules::Rule>& rules = action.options->boundary.groups;
    for (const std::string& name : names) {
        std::erase_if(rules, [&](const BoundaryRules::Rule& rule) { return rule.group == name; });
        rules.push_back({name, BoundaryMode::slide});
    }
    return action;
}

}  // namespace curvewright
