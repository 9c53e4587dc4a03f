#pragma once

#include <memory>
#include <vector>

#include <QDateTime>
#include <QObject>

#include "core/mesh/mesh_topology.h"
#include "ui/document/notice.h"

namespace curvewright {

/// One thing that was told.
struct LogEntry {
    QDateTime time;
    QString step;  ///< of the history, or what else it belongs to
    NoticeSeverity severity = NoticeSeverity::information;
    QString text;
    std::vector<Index> elements = {}, nodes = {};     ///< that it speaks of; empty: of none in particular
    std::weak_ptr<const MeshTopology> topology = {};  ///< that these belong to
};

/// Everything that was told in a session of the program, in the order of time.
class MessageLog : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;

    const std::vector<LogEntry>& entries() const { return entries_; }
    /// Adds an entry; one without a time gets the present one. What is a part of the last one, of the same step, is not
    /// said twice: that one gets the elements, the nodes and the severity if it is higher.
    void add(LogEntry entry);
    void clear();

    /// An entry as a line of a table: time, kind, step, text.
    static QString line(const LogEntry& entry);

  signals:
    void added();
    /// The last entry has become another one.
    void last_changed();
    void cleared();

  private:
    std::vector<LogEntry> entries_;
};

/// The entry that a notice makes. topology: of the mesh that it is about; null = none.
LogEntry log_entry(const Notice& notice, const QString& step, const std::shared_ptr<const MeshTopology>& topology);

}  // namespace curvewright
