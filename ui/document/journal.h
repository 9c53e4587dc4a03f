#pragma once

#include <memory>
#include <vector>

#include <QDateTime>
#include <QObject>
#include <QString>

#include "ui/document/mesh_document.h"

class QLockFile;

namespace curvewright {

/// What a program that ended unexpectedly has left.
struct LostWork {
    QString path;       ///< of the journal: a file for read_journal()
    QString mesh_path;  ///< the mesh that was open
    QStringList steps;  ///< names of the steps up to the state that is kept
    QDateTime time;     ///< of the last of what was done
};

/// Keeps what is not saved yet on disk, so that a crash loses nothing: one file that grows by what every step adds,
/// with which the whole history comes back. One journal per program, gone when the program ends as it should; those
/// that belong to no living program are lost work, if something in them was not saved. Written on a thread of its own.
/// Failures to write are no reason to disturb the user: is_working() tells, and the next step tries again.
class Journal : public QObject {
    Q_OBJECT

  public:
    /// folder: made if needed.
    Journal(MeshDocument& document, const QString& folder, QObject* parent = nullptr);
    ~Journal() override;

    bool is_working() const;
    /// Waits until everything that was done is on disk.
    void finish_writing();
    /// Whether work is written down from now on (at first it is); what is there of this program goes otherwise.
    void set_keeping(bool keeps);

    /// Work of programs that are no longer alive, the latest first. It is reserved for this program until it is
    /// discarded or taken over, so that two windows do not offer the same.
    QList<LostWork> find_lost_work();
    void discard(const LostWork& lost);
    /// The document is what the lost work was, up to so many bytes of its file: goes on with it.
    void take_over(const LostWork& lost, quint64 intact_bytes, quint32 records);
    /// Where a folder for the program's journals is.
    static QString standard_folder();

  private:
    class Writer;

    QString file() const;
    void start_anew();
    void begin();
    void append_step(int at);
    void append_jump(int index);
    void follow(const Action& action);
    void follow_saving();
    void release(const LostWork& lost);

    MeshDocument& document_;
    QString folder_, stem_;
    bool has_begun_ = false, keeps_ = true;
    quint32 records_ = 0;  ///< written, or waiting to be
    int told_clean_ = 0;   ///< that the file knows
    QString told_path_;
    std::unique_ptr<QLockFile> lock_;
    std::vector<std::unique_ptr<QLockFile>> reserved_;
    std::unique_ptr<Writer> writer_;
};

}  // namespace curvewright
