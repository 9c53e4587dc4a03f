#include "ui/document/core_words.h"

#include <QCoreApplication>
#include <QRegularExpression>

namespace curvewright {
namespace {

// The phases are looked up by what the core reports; these are here to be translated.
[[maybe_unused]] const char* const phases[] = {
    QT_TRANSLATE_NOOP("Phase", "reading"),
    QT_TRANSLATE_NOOP("Phase", "writing"),
    QT_TRANSLATE_NOOP("Phase", "Raising the order"),
    QT_TRANSLATE_NOOP("Phase", "Certifying elements"),
    QT_TRANSLATE_NOOP("Phase", "Finding neighbours"),
    QT_TRANSLATE_NOOP("Phase", "Computing weights"),
    QT_TRANSLATE_NOOP("Phase", "Assembling the elastic body"),
    QT_TRANSLATE_NOOP("Phase", "Preparing the solver"),
    QT_TRANSLATE_NOOP("Phase", "Factorising"),
    QT_TRANSLATE_NOOP("Phase", "Solving"),
    QT_TRANSLATE_NOOP("Phase", "Warping step by step"),
    QT_TRANSLATE_NOOP("Phase", "Making elements valid"),
    QT_TRANSLATE_NOOP("Phase", "Improving"),
    QT_TRANSLATE_NOOP("Phase", "Untangling, pass %1"),
};

QString tr(const char* text) {
    return QCoreApplication::translate("Shape", text);
}

}  // namespace

QString shape_name(Shape shape, long count) {
    const bool is_one = count == 1;
    switch (shape) {
        case Shape::vertex:
            return is_one ? tr("vertex") : tr("vertices");
        case Shape::line:
            return is_one ? tr("line") : tr("lines");
        case Shape::triangle:
            return is_one ? tr("triangle") : tr("triangles");
        case Shape::quadrilateral:
            return is_one ? tr("quadrilateral") : tr("quadrilaterals");
        case Shape::tetrahedron:
            return is_one ? tr("tetrahedron") : tr("tetrahedra");
        case Shape::hexahedron:
            return is_one ? tr("hexahedron") : tr("hexahedra");
        case Shape::prism:
            return is_one ? tr("prism") : tr("prisms");
        case Shape::pyramid:
            return is_one ? tr("pyramid") : tr("pyramids");
    }
    return {};
}

QString type_name(ElementType type) {
    return QStringLiteral("P%1 %2").arg(type.order).arg(shape_name(type.shape, 1));
}

QString phase_text(const QString& phase) {
    static const QRegularExpression number(QStringLiteral("\\d+$"));
    const QRegularExpressionMatch match = number.match(phase);
    const QString words = match.hasMatch() ? phase.left(match.capturedStart()) + QStringLiteral("%1") : phase;
    const QString text = QCoreApplication::translate("Phase", words.toUtf8().constData());
    return match.hasMatch() ? text.arg(match.captured()) : text;
}

}  // namespace curvewright
