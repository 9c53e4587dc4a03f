#pragma once

#include <vector>

#include <QString>

#include "ui/panels/group_table.h"
#include "ui/panels/histogram_drawing.h"

namespace curvewright {

/// A mesh before and now, as a file can hold it.
struct QualityComparison {
    struct Side {
        QString title, figures;
        HistogramDrawing drawing;
    };
    Side before, now;
    bool is_overlay = false;
    std::vector<GroupFigures> groups;  ///< the whole mesh among them
};

/// A table with one heading: a line per bar ("bin"), then one per group ("group", and "mesh" for all elements). Fields
/// that a line has no value for are empty; numbers have 17 digits.
QByteArray comparison_csv(const QualityComparison& comparison);
QByteArray comparison_svg(const QualityComparison& comparison);
QByteArray comparison_png(const QualityComparison& comparison);

/// One of these by the file's suffix. Appears complete or not at all. Throws InvalidInput that names the file.
void write_comparison(const QualityComparison& comparison, const QString& path);

}  // namespace curvewright
