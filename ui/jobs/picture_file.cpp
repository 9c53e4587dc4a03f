#include "ui/jobs/picture_file.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QImageWriter>
#include <QSaveFile>

#include "core/base/error.h"

namespace curvewright {

QByteArray encode_png(const QImage& image) {
    QByteArray bytes;
    QBuffer buffer(&bytes);
    buffer.open(QIODevice::WriteOnly);
    QImageWriter writer(&buffer, "png");
    if (!writer.write(image)) throw Unsupported(writer.errorString().toStdString());
    return bytes;
}

void write_bytes(const QString& path, const QByteArray& bytes, const TaskContext& context) {
    QSaveFile file(path);
    const bool is_written = file.open(QIODevice::WriteOnly) && file.write(bytes) == bytes.size();
    context.check();
    if (!is_written || !file.commit())
        throw InvalidInput(path.toStdString(), 0,
                           QCoreApplication::translate("curvewright::MeshJobs", "cannot be written: %1.")
                               .arg(file.errorString())
                               .toStdString());
}

}  // namespace curvewright
