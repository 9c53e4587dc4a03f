#include "ui/document/number_format.h"

#include <cmath>

#include <QLocale>

namespace curvewright {

QString format_number(double value) {
    if (!std::isfinite(value)) return QStringLiteral("–");
    const double size = std::abs(value);
    QString text;
    if (value == 0.0) {
        text = QStringLiteral("0");
    } else if (size >= 1e-4 && size < 1e6) {
        // Rounding can carry into a new digit (0.9996 -> 1.00), so the magnitude is taken after it.
        const double rounded = QString::number(size, 'e', 2).toDouble();
        const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(rounded))));
        text = QString::number(size, 'f', decimals);
    } else {
        text = QString::number(size, 'g', 3);
        text.replace(QLatin1Char('-'), QChar(0x2212));
    }
    return value < 0.0 ? QChar(0x2212) + text : text;
}

QString format_component(double value, double length) {
    constexpr double rounding = 1e-12;
    return format_number(std::abs(value) < rounding * length ? 0.0 : value);
}

QString short_number(double value) {
    return QString::number(value, 'g', 3).replace(QLatin1Char('-'), QChar(0x2212));
}

QString format_count(long long value) {
    QString text = QLocale(QLocale::English, QLocale::UnitedStates).toString(value);
    text.replace(QLatin1Char('-'), QChar(0x2212));
    return text;
}

QString exact_number(double value) {
    return QString::number(value, 'g', 17);
}

}  // namespace curvewright
