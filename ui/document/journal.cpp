#include "ui/document/journal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLockFile>
#include <QSaveFile>
#include <QStandardPaths>
#include <QTimer>
#include <QUuid>

#include "core/base/error.h"
#include "core/session/session_file.h"

namespace curvewright {
namespace {

// stem.lock      held while the program lives
// stem.json      mesh, steps, time
// stem.positions header, number of nodes, 3 doubles each: of the machine that wrote them
// stem.session   the session, one action per line
constexpr char header[8] = {'C', 'W', 'P', 'O', 'S', '1', 0, 0};

std::unique_ptr<QLockFile> make_lock(const QString& stem) {
    auto lock = std::make_unique<QLockFile>(stem + QStringLiteral(".lock"));
    lock->setStaleLockTime(0);  // stale when its program is dead, however long it has lived
    return lock;
}

bool write_file(const QString& path, const QByteArray& content) {
    QSaveFile file(path);
    return file.open(QIODevice::WriteOnly) && file.write(content) == content.size() && file.commit();
}

void remove_files(const QString& stem) {
    for (const char* suffix : {".json", ".positions", ".session"}) QFile::remove(stem + QLatin1String(suffix));
}

}  // namespace

QString Journal::standard_folder() {
    return QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + QStringLiteral("/journal");
}

Journal::Journal(MeshDocument& document, const QString& folder, QObject* parent)
    : QObject(parent), document_(document), folder_(folder) {
    QDir().mkpath(folder);
    stem_ = QDir(folder).filePath(QUuid::createUuid().toString(QUuid::WithoutBraces));
    lock_ = make_lock(stem_);
    is_working_ = lock_->tryLock(0);
    connect(&document, &MeshDocument::state_changed, this, &Journal::follow);
    connect(&document, &MeshDocument::dirty_changed, this, &Journal::follow);
}

Journal::~Journal() {
    // The end of a program that was asked to end: what is not saved was given up.
    erase();
}

void Journal::set_keeping(bool keeps) {
    if (keeps == keeps_) return;
    keeps_ = keeps;
    follow();
}

void Journal::follow() {
    // A step changes several things at once: write it once.
    if (std::exchange(is_due_, true)) return;
    QTimer::singleShot(0, this, &Journal::follow_now);
}

void Journal::follow_now() {
    is_due_ = false;
    if (keeps_ && document_.is_dirty())
        write();
    else
        erase();
}

void Journal::write() {
    if (!lock_->isLocked()) return;
    const Coordinates& x = document_.state().mesh->coordinates();
    const auto count = static_cast<std::int64_t>(x.rows());
    QByteArray positions(header, sizeof header);
    positions.append(reinterpret_cast<const char*>(&count), sizeof count);
    positions.append(reinterpret_cast<const char*>(x.data()), static_cast<qsizetype>(x.size() * sizeof(double)));
    QJsonArray steps;
    for (int i = 0; i < document_.history()->index(); ++i) steps.append(document_.history()->text(i));
    const QJsonObject card{{QStringLiteral("mesh"), document_.file_path()},
                           {QStringLiteral("steps"), steps},
                           {QStringLiteral("time"), QDateTime::currentDateTime().toString(Qt::ISODateWithMs)}};
    QByteArray session;
    for (const Action& action : document_.session()) session += QByteArray::fromStdString(to_json_line(action)) + '\n';
    has_files_ = true;
    // The card last: with it the rest is complete.
    is_working_ = write_file(stem_ + QStringLiteral(".positions"), positions) &&
                  write_file(stem_ + QStringLiteral(".session"), session) &&
                  write_file(stem_ + QStringLiteral(".json"), QJsonDocument(card).toJson());
}

void Journal::erase() {
    if (has_files_) remove_files(stem_);
    has_files_ = false;
}

QList<LostWork> Journal::find_lost_work() {
    QList<LostWork> found;
    const QDir folder(folder_);
    for (const QString& name : folder.entryList({QStringLiteral("*.json")}, QDir::Files)) {
        LostWork lost;
        lost.path = folder.filePath(name.chopped(5));
        if (lost.path == stem_) continue;
        auto lock = make_lock(lost.path);
        if (!lock->tryLock(0)) continue;  // its program is alive, or another one is asking just now
        QFile file(folder.filePath(name));
        if (!file.open(QIODevice::ReadOnly)) continue;
        const QJsonObject card = QJsonDocument::fromJson(file.readAll()).object();
        lost.mesh_path = card[QStringLiteral("mesh")].toString();
        for (const auto& step : card[QStringLiteral("steps")].toArray()) lost.steps << step.toString();
        lost.time = QDateTime::fromString(card[QStringLiteral("time")].toString(), Qt::ISODateWithMs);
        if (lost.mesh_path.isEmpty() || !QFile::exists(lost.path + QStringLiteral(".positions"))) {
            remove_files(lost.path);
            continue;
        }
        reserved_.push_back(std::move(lock));
        found << lost;
    }
    std::sort(found.begin(), found.end(), [](const LostWork& a, const LostWork& b) { return a.time > b.time; });
    return found;
}

Coordinates Journal::read_positions(const LostWork& lost, Index node_count) {
    const QString path = lost.path + QStringLiteral(".positions");
    QFile file(path);
    const auto fail = [&path](const std::string& what) -> InvalidInput {
        return InvalidInput(path.toStdString(), 0, what);
    };
    if (!file.open(QIODevice::ReadOnly)) throw fail("the kept positions cannot be read.");
    const QByteArray content = file.readAll();
    std::int64_t count = -1;
    if (content.size() < static_cast<qsizetype>(sizeof header + sizeof count) ||
        std::memcmp(content.data(), header, sizeof header) != 0)
        throw fail("these are no kept positions.");
    std::memcpy(&count, content.data() + sizeof header, sizeof count);
    const auto wanted = static_cast<qsizetype>(sizeof header + sizeof count) + 24 * static_cast<qsizetype>(node_count);
    if (count != node_count || content.size() != wanted)
        throw fail("the kept positions are of " + std::to_string(count) + " nodes, the mesh file has " +
                   std::to_string(node_count) + ": it has changed since.");
    Coordinates x(node_count, 3);
    std::memcpy(x.data(), content.data() + sizeof header + sizeof count, static_cast<std::size_t>(24) * node_count);
    if (!x.allFinite()) throw fail("the kept positions are damaged.");
    return x;
}

void Journal::discard(const LostWork& lost) {
    remove_files(lost.path);
    std::erase_if(reserved_, [&](const auto& lock) { return lock->fileName() == lost.path + QStringLiteral(".lock"); });
}

}  // namespace curvewright
