#pragma once

#include <QByteArray>
#include <QImage>
#include <QString>

#include "core/base/task.h"

namespace curvewright {

/// A picture as a PNG file in memory. Throws Unsupported if that fails.
QByteArray encode_png(const QImage& image);
/// Appears complete or not at all. Throws InvalidInput that names the file, and Cancelled before it appears.
void write_bytes(const QString& path, const QByteArray& bytes, const TaskContext& context);

}  // namespace curvewright
