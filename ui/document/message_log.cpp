#include "ui/document/message_log.h"

#include <algorithm>

namespace curvewright {

void MessageLog::add(LogEntry entry) {
    if (!entry.time.isValid()) entry.time = QDateTime::currentDateTime();
    if (!entries_.empty()) {
        LogEntry& last = entries_.back();
        const bool says_more = entry.severity > last.severity || !entry.elements.empty() || !entry.nodes.empty() ||
                               entry.text.size() < last.text.size();
        if (last.step == entry.step && last.text.contains(entry.text) && says_more) {
            last.severity = std::max(last.severity, entry.severity);
            if (!entry.elements.empty()) last.elements = std::move(entry.elements);
            if (!entry.nodes.empty()) last.nodes = std::move(entry.nodes);
            if (!entry.topology.expired()) last.topology = entry.topology;
            emit last_changed();
            return;
        }
    }
    entries_.push_back(std::move(entry));
    emit added();
}

void MessageLog::clear() {
    entries_.clear();
    emit cleared();
}

QString MessageLog::line(const LogEntry& entry) {
    QString text = entry.text;
    return QStringList{entry.time.toString(QStringLiteral("yyyy-MM-dd HH:mm:ss")), severity_text(entry.severity),
                       entry.step, text.replace(QLatin1Char('\n'), QLatin1Char(' '))}
        .join(QLatin1Char('\t'));
}

LogEntry log_entry(const Notice& notice, const QString& step, const std::shared_ptr<const MeshTopology>& topology) {
    LogEntry entry;
    entry.step = step;
    entry.severity = notice.severity;
    entry.text = notice.text;
    for (const NoticeAction& action : notice.actions) {
        if (action.command == NoticeCommand::select_elements) entry.elements = action.items;
        if (action.command == NoticeCommand::select_nodes) entry.nodes = action.items;
    }
    if (!entry.elements.empty() || !entry.nodes.empty()) entry.topology = topology;
    return entry;
}

}  // namespace curvewright
