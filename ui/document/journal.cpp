#include "ui/document/journal.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include <QDir>
#include <QFile>
#include <QLockFile>
#include <QStandardPaths>
#include <QTimer>
#include <QUuid>

#include "core/base/error.h"
#include "core/session/journal_file.h"

namespace curvewright {
namespace {

// stem.lock     held while the program lives
// stem.journal  see core/session/journal_file.h

std::unique_ptr<QLockFile> make_lock(const QString& stem) {
    auto lock = std::make_unique<QLockFile>(stem + QStringLiteral(".lock"));
    lock->setStaleLockTime(0);  // stale when its program is dead, however long it has lived
    return lock;
}

QString lock_file_of(const LostWork& lost) {
    return lost.path.chopped(static_cast<qsizetype>(qstrlen(".journal"))) + QStringLiteral(".lock");
}

std::filesystem::path to_path(const QString& path) {
    return {path.toStdU16String()};
}

std::vector<std::string> to_texts(const QStringList& list) {
    std::vector<std::string> texts;
    for (const QString& text : list) texts.push_back(text.toStdString());
    return texts;
}

}  // namespace

/// Makes records and writes them, one after another, on a thread. What it is given is immutable.
class Journal::Writer {
  public:
    using Record = std::function<std::string()>;

    Writer() : thread_([this](const std::stop_token& stop) { run(stop); }) {}
    /// Does what waits before.
    ~Writer() {
        thread_.request_stop();
        wake_.notify_all();
    }

    /// From now on records go to this file. kept_bytes: see JournalFile.
    void set_file(const QString& path, quint64 kept_bytes) {
        add([this, path, kept_bytes] { journal_ = std::make_unique<JournalFile>(to_path(path), kept_bytes); });
    }
    void append(Record make_record) {
        add([this, make_record = std::move(make_record)] {
            bool is_written = false;
            try {
                is_written = journal_ && journal_->append(make_record());
            } catch (const std::exception&) {
                // Not even the memory for it: the file ends here, and what follows would not fit.
                journal_.reset();
            }
            is_working_ = is_written;
        });
    }
    /// Drops what waits and removes the file, as soon as what runs has ended.
    void remove(const QString& path) {
        {
            const std::lock_guard lock(mutex_);
            tasks_.clear();
        }
        add([this, path] {
            journal_.reset();
            QFile::remove(path);
            is_working_ = true;
        });
    }
    void wait() {
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return tasks_.empty() && !is_busy_; });
    }
    bool is_working() const { return is_working_; }

  private:
    void add(std::function<void()> task) {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
        wake_.notify_all();
    }
    void run(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        while (wake_.wait(lock, stop, [this] { return !tasks_.empty(); })) {
            const std::function<void()> task = std::move(tasks_.front());
            tasks_.pop_front();
            is_busy_ = true;
            lock.unlock();
            task();
            lock.lock();
            is_busy_ = false;
            done_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable_any wake_, done_;
    std::deque<std::function<void()>> tasks_;
    bool is_busy_ = false;
    std::atomic<bool> is_working_ = true;
    std::unique_ptr<JournalFile> journal_;  ///< the thread's own
    std::jthread thread_;
};

QString Journal::standard_folder() {
    return QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + QStringLiteral("/journal");
}

Journal::Journal(MeshDocument& document, const QString& folder, QObject* parent)
    : QObject(parent), document_(document), folder_(folder), writer_(std::make_unique<Writer>()) {
    QDir().mkpath(folder);
    stem_ = QDir(folder).filePath(QUuid::createUuid().toString(QUuid::WithoutBraces));
    lock_ = make_lock(stem_);
    lock_->tryLock(0);
    connect(&document, &MeshDocument::opened, this, &Journal::start_anew);
    connect(&document, &MeshDocument::recorded, this, &Journal::follow);
    connect(&document, &MeshDocument::dirty_changed, this, &Journal::follow_saving);
    connect(&document, &MeshDocument::file_path_changed, this, &Journal::follow_saving);
    connect(&document, &MeshDocument::deformation_changed, this, [this] {
        const auto& loaded = document_.deformation();
        if (!has_begun_ || !loaded) return;
        writer_->append([number = records_++, file = loaded->file_path.toStdString()] {
            return journal_deformation(number, file);
        });
    });
}

Journal::~Journal() {
    // The end of a program that was asked to end: what is not saved was given up.
    if (has_begun_) writer_->remove(file());
}

QString Journal::file() const {
    return stem_ + QStringLiteral(".journal");
}

bool Journal::is_working() const {
    return lock_->isLocked() && writer_->is_working();
}

void Journal::set_keeping(bool keeps) {
    if (keeps == keeps_) return;
    keeps_ = keeps;
    if (!keeps) {
        if (has_begun_) writer_->remove(file());
        has_begun_ = false;
        records_ = 0;
    } else if (document_.history()->count() > 0) {
        begin();
    }
}

void Journal::finish_writing() {
    writer_->wait();
}

void Journal::start_anew() {
    if (has_begun_) writer_->remove(file());
    has_begun_ = false;
    records_ = 0;
    // A document that comes with a history is kept at once, unless it is taken over from another journal.
    if (document_.history()->count() > 0)
        QTimer::singleShot(0, this, [this] {
            if (!has_begun_ && document_.history()->count() > 0) begin();
        });
}

void Journal::begin() {
    if (!keeps_ || !lock_->isLocked()) return;
    has_begun_ = true;
    writer_->set_file(file(), 0);
    told_path_ = document_.file_path();
    JournalHead head;
    head.mesh = std::get<OpenAction>(document_.session().front()).mesh;
    head.saved = told_path_.toStdString();
    head.clean = told_clean_ = document_.history()->cleanIndex() < 0 ? -1 : 0;
    writer_->append([head, mesh = document_.original().mesh]() mutable {
        head.topology = fingerprint(mesh->topology());
        return journal_head(head, mesh->coordinates());
    });
    records_ = 1;
    if (const auto& loaded = document_.deformation())
        writer_->append([number = records_++, file = loaded->file_path.toStdString()] {
            return journal_deformation(number, file);
        });
    const int count = document_.history()->count(), index = document_.history()->index();
    for (int step = 0; step < count; ++step) append_step(step);
    if (index != count) append_jump(index);
    follow_saving();
}

void Journal::append_step(int at) {
    const MeshState& after = document_.state_at(at + 1);
    JournalStep step{document_.history()->text(at).toStdString(), document_.step_details(at).toStdString(),
                     document_.step_action(at), to_texts(after.applied_deformations)};
    writer_->append(
        [number = records_++, at, step = std::move(step), before = document_.state_at(at).mesh, after = after.mesh] {
            return journal_step(number, at, step, before->coordinates(), after->coordinates());
        });
}

void Journal::append_jump(int index) {
    writer_->append([number = records_++, index] { return journal_jump(number, index); });
}

void Journal::follow(const Action& action) {
    if (std::holds_alternative<OpenAction>(action)) return;
    if (!has_begun_) return begin();
    if (const auto* jump = std::get_if<HistoryAction>(&action)) return append_jump(jump->step);
    const int at = document_.history()->index() - 1;
    // What had been undone is gone.
    if (told_clean_ > at) told_clean_ = -1;
    append_step(at);
}

void Journal::follow_saving() {
    if (!has_begun_) return;
    // A step is told before what it does to the saved state among those that it has replaced.
    const int clean = document_.history()->cleanIndex();
    if (clean < 0 || (clean == told_clean_ && document_.file_path() == told_path_)) return;
    told_clean_ = clean;
    told_path_ = document_.file_path();
    writer_->append(
        [number = records_++, clean, file = told_path_.toStdString()] { return journal_clean(number, clean, file); });
}

QList<LostWork> Journal::find_lost_work() {
    QList<LostWork> found;
    const QDir folder(folder_);
    for (const QString& name : folder.entryList({QStringLiteral("*.journal")}, QDir::Files)) {
        LostWork lost;
        lost.path = folder.filePath(name);
        if (lost.path == file()) continue;
        auto lock = make_lock(lost.path.chopped(static_cast<qsizetype>(qstrlen(".journal"))));
        if (!lock->tryLock(0)) continue;  // its program is alive, or another one is asking just now
        try {
            const JournalSummary summary = summarize_journal(to_path(lost.path));
            if (summary.is_dirty()) {
                lost.mesh_path = QString::fromStdString(summary.saved.empty() ? summary.mesh : summary.saved);
                for (const std::string& step : summary.steps) lost.steps << QString::fromStdString(step);
                lost.time = QDateTime::fromMSecsSinceEpoch(summary.time);
                reserved_.push_back(std::move(lock));
                found << lost;
                continue;
            }
        } catch (const Error&) {
            // Not even a mesh to open.
        }
        QFile::remove(lost.path);
    }
    std::sort(found.begin(), found.end(), [](const LostWork& a, const LostWork& b) { return a.time > b.time; });
    return found;
}

void Journal::release(const LostWork& lost) {
    std::erase_if(reserved_, [&](const auto& lock) { return lock->fileName() == lock_file_of(lost); });
}

void Journal::discard(const LostWork& lost) {
    QFile::remove(lost.path);
    release(lost);
}

void Journal::take_over(const LostWork& lost, quint64 intact_bytes, quint32 records) {
    start_anew();
    writer_->wait();
    // Who wants nothing written finds it again at the next start.
    if (!keeps_) return;
    if (!lock_->isLocked() || !QFile::rename(lost.path, file())) return;
    has_begun_ = true;
    records_ = records;
    told_clean_ = document_.history()->cleanIndex();
    told_path_ = document_.file_path();
    writer_->set_file(file(), intact_bytes);
    release(lost);
}

}  // namespace curvewright
