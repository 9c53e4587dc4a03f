#include "ui/panels/quality_export.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QFileInfo>
#include <QPainter>
#include <QSvgGenerator>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "ui/jobs/mesh_state.h"
#include "ui/jobs/picture_file.h"

namespace curvewright {
namespace {

constexpr int plot_width = 480, plot_height = 240, overlay_width = 720, figures_height = 22, gap = 24, margin = 16;
constexpr int png_scale = 2;  ///< pixels per unit

QString tr(const char* text) {
    return QCoreApplication::translate("curvewright::QualityPanel", text);
}

QString number(double value) {
    return QString::number(value, 'g', 17);
}

/// As RFC 4180 wants it.
QString field(QString text) {
    if (!text.contains(QLatin1Char(',')) && !text.contains(QLatin1Char('"')) && !text.contains(QLatin1Char('\n')) &&
        !text.contains(QLatin1Char('\r')))
        return text;
    return QLatin1Char('"') + text.replace(QLatin1Char('"'), QStringLiteral("\"\"")) + QLatin1Char('"');
}

/// Size of the drawing without its margins.
QSize drawing_size(const QualityComparison& comparison) {
    return comparison.is_overlay ? QSize(overlay_width, plot_height + 2 * figures_height)
                                 : QSize(2 * plot_width + gap, plot_height + figures_height);
}

void draw(QPainter& painter, const QualityComparison& comparison) {
    const HistogramInk ink = paper_ink();
    QFont font;
    font.setPixelSize(12);
    const QSize size = drawing_size(comparison) + QSize(2 * margin, 2 * margin);
    painter.fillRect(QRect(QPoint(0, 0), size), ink.ground);
    const auto draw_side = [&](const QualityComparison::Side& side, int left, int width) {
        HistogramDrawing drawing = side.drawing;
        drawing.frame = QRectF(left, margin, width, plot_height);
        drawing.font = font;
        drawing.marked_bar = HistogramBars::no_bar;
        drawing.band_last = HistogramBars::no_bar;
        drawing.draw(painter, ink);
        painter.setPen(ink.muted);
        painter.drawText(QRectF(left, margin, width - 8, 16), Qt::AlignRight | Qt::AlignVCenter,
                         drawing.is_logarithmic ? tr("elements by scaled Jacobian, logarithmic")
                                                : tr("elements by scaled Jacobian"));
    };
    const auto write = [&](const QString& text, int left, int line, int width) {
        painter.setFont(font);
        painter.setPen(ink.text);
        painter.drawText(QRectF(left, margin + plot_height + line * figures_height, width, figures_height),
                         Qt::AlignLeft | Qt::AlignVCenter, text);
    };
    if (comparison.is_overlay) {
        draw_side(comparison.now, margin, overlay_width);
        const QString line = QStringLiteral("%1: %2");
        write(line.arg(comparison.before.title, comparison.before.figures), margin, 0, overlay_width);
        write(line.arg(comparison.now.title, comparison.now.figures), margin, 1, overlay_width);
        return;
    }
    const int second = margin + plot_width + gap;
    draw_side(comparison.before, margin, plot_width);
    write(comparison.before.figures, margin, 0, plot_width);
    draw_side(comparison.now, second, plot_width);
    write(comparison.now.figures, second, 0, plot_width);
}

}  // namespace

QByteArray comparison_csv(const QualityComparison& comparison) {
    const bool has_before = comparison.before.drawing.has_data, has_now = comparison.now.drawing.has_data;
    QString text = QStringLiteral(
        "part,name,lower,upper,elements_before,elements_now,undecided_before,undecided_now,selected_before,selected_"
        "now,"
        "tangled_before,tangled_now,min_before,min_now,mean_before,mean_now,max_before,max_now\n");
    const auto add_line = [&text](QStringList fields) {
        for (QString& entry : fields) entry = field(entry);
        text += fields.join(QLatin1Char(',')) + QLatin1Char('\n');
    };
    const auto add_pair = [&](QStringList& fields, const QString& before, const QString& now) {
        fields << (has_before ? before : QString()) << (has_now ? now : QString());
    };
    const QString none;
    for (int i = HistogramBars::tangled_bar; i < HistogramBars::bins; ++i) {
        const HistogramBars::Bar &before = comparison.before.drawing.bars.at(i),
                                 &now = comparison.now.drawing.bars.at(i);
        QStringList fields{QStringLiteral("bin")};
        if (i < 0)
            fields << QStringLiteral("tangled") << none << none;
        else
            fields << none << number(HistogramBars::lower(i)) << number(HistogramBars::lower(i + 1));
        add_pair(fields, QString::number(before.count()), QString::number(now.count()));
        add_pair(fields, QString::number(before.undecided), QString::number(now.undecided));
        add_pair(fields, QString::number(before.selected), QString::number(now.selected));
        for (int rest = 0; rest < 8; ++rest) fields << none;
        add_line(fields);
    }
    for (const GroupFigures& group : comparison.groups) {
        QStringList fields{group.is_whole ? QStringLiteral("mesh") : QStringLiteral("group"),
                           group.is_whole ? none : group.name, none, none};
        add_pair(fields, QString::number(group.before.elements()), QString::number(group.now.elements()));
        add_pair(fields, QString::number(group.before.undecided), QString::number(group.now.undecided));
        fields << none << none;
        add_pair(fields, QString::number(group.before.invalid), QString::number(group.now.invalid));
        add_pair(fields, number(group.before.min), number(group.now.min));
        add_pair(fields, number(group.before.mean), number(group.now.mean));
        add_pair(fields, number(group.before.max), number(group.now.max));
        add_line(fields);
    }
    return text.toUtf8();
}

QByteArray comparison_svg(const QualityComparison& comparison) {
    const QSize size = drawing_size(comparison) + QSize(2 * margin, 2 * margin);
    QByteArray bytes;
    QBuffer buffer(&bytes);
    buffer.open(QIODevice::WriteOnly);
    QSvgGenerator generator;
    generator.setOutputDevice(&buffer);
    generator.setResolution(96);  // of browsers
    generator.setSize(size);
    generator.setViewBox(QRect(QPoint(0, 0), size));
    generator.setTitle(tr("Scaled Jacobian, before and now"));
    generator.setDescription(QString());
    QPainter painter(&generator);
    draw(painter, comparison);
    painter.end();
    return bytes;
}

QByteArray comparison_png(const QualityComparison& comparison) {
    const QSize size = drawing_size(comparison) + QSize(2 * margin, 2 * margin);
    QImage image(size * png_scale, QImage::Format_RGB32);
    QPainter painter(&image);
    painter.setRenderHint(QPainter::TextAntialiasing);
    painter.scale(png_scale, png_scale);
    draw(painter, comparison);
    painter.end();
    return encode_png(image);
}

void write_comparison(const QualityComparison& comparison, const QString& path) {
    const QString suffix = QFileInfo(path).suffix().toLower();
    QByteArray bytes;
    if (suffix == u"csv")
        bytes = comparison_csv(comparison);
    else if (suffix == u"svg")
        bytes = comparison_svg(comparison);
    else if (suffix == u"png")
        bytes = comparison_png(comparison);
    else
        throw InvalidInput(path.toStdString(), 0,
                           tr("what to write is told by the end of the name: .csv, .svg or .png.").toStdString());
    write_text_file(to_path(path), {bytes.constData(), static_cast<std::size_t>(bytes.size())});
}

}  // namespace curvewright
