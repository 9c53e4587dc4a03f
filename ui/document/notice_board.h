#pragma once

#include <memory>
#include <set>
#include <vector>

#include <QObject>

#include "ui/document/mesh_document.h"
#include "ui/document/notice.h"

namespace curvewright {

/// What the present state of a document has to tell by itself, whatever was done to it.
std::vector<Notice> standing_notices(const MeshDocument& document);

/// The notices that hold for what a document shows now: those that were posted, as long as they live and nobody has
/// dismissed them, and the standing ones.
class NoticeBoard : public QObject {
    Q_OBJECT

  public:
    explicit NoticeBoard(const MeshDocument& document, QObject* parent = nullptr);

    /// A notice and its number, by which it is dismissed.
    struct Line {
        int id = 0;
        Notice notice;
    };
    /// The most severe first, the newest of them first.
    const std::vector<Line>& lines() const { return lines_; }
    /// One of lines(); null if it is not there (any more).
    const Notice* find(int id) const;

    /// A notice about the state that the document is in now.
    void post(Notice notice);
    void dismiss(int id);

  signals:
    /// lines() are others than before.
    void changed();

  private:
    struct Entry {
        Line line;
        std::weak_ptr<const CurvedMesh> about;  ///< of the state; null: no mesh
        bool is_dismissed = false, is_standing = false;
    };

    bool is_alive(const Entry& entry) const;
    void follow_document();
    void refresh();

    const MeshDocument& document_;
    std::vector<Entry> entries_;
    std::vector<Line> lines_;
    int last_id_ = 0;
};

}  // namespace curvewright
