#pragma once

#include <memory>
#include <optional>

#include <QDateTime>
#include <QObject>
#include <QString>

#include "ui/document/mesh_document.h"

class QLockFile;

namespace curvewright {

/// What a program that ended unexpectedly has left.
struct LostWork {
    QString path;       ///< of the journal, without suffix
    QString mesh_path;  ///< the mesh that was open
    QStringList steps;  ///< names of the steps up to the state that is kept
    QDateTime time;     ///< of the last step
};

/// Keeps what is not saved yet on disk, so that a crash loses nothing: after every step the positions of the nodes, and
/// the session so far. The files are gone as soon as nothing would be lost. One journal per program; those that belong
/// to no living program are lost work. Failures to write are no reason to disturb the user: is_working() tells.
class Journal : public QObject {
    Q_OBJECT

  public:
    /// folder: made if needed.
    Journal(MeshDocument& document, const QString& folder, QObject* parent = nullptr);
    ~Journal() override;

    bool is_working() const { return is_working_; }
    /// Whether work is written down from now on (at first it is); what is there of this program goes otherwise.
    void set_keeping(bool keeps);

    /// Work of programs that are no longer alive, the latest first. It is reserved for this program until it is
    /// discarded, so that two windows do not offer the same.
    QList<LostWork> find_lost_work();
    /// Positions that lost work had reached. Throws InvalidInput that names the file if it is damaged or has another
    /// number of nodes.
    static Coordinates read_positions(const LostWork& lost, Index node_count);
    void discard(const LostWork& lost);
    /// Where a folder for the program's journals is.
    static QString standard_folder();

  private:
    void follow();
    void follow_now();
    void write();
    void erase();

    MeshDocument& document_;
    QString folder_, stem_;
    bool is_working_ = false, has_files_ = false, is_due_ = false, keeps_ = true;
    std::unique_ptr<QLockFile> lock_;
    std::vector<std::unique_ptr<QLockFile>> reserved_;
};

}  // namespace curvewright
