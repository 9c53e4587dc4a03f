#include "ui/document/deformation_text.h"

#include <QCoreApplication>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("Deformation", text);
}

QString short_number(double value) {
    QString text = QString::number(value, 'g', 4);
    text.replace(QLatin1Char('-'), QChar(0x2212));
    return text;
}

QString vector(const Vector3& v) {
    return QStringLiteral("(%1, %2, %3)").arg(short_number(v[0]), short_number(v[1]), short_number(v[2]));
}

QString axis_name(int axis) {
    return QString(QLatin1Char("xyz"[axis]));
}

struct Describe {
    QString operator()(const Translate& o) const { return tr("translate by %1").arg(vector(o.vector)); }
    QString operator()(const Rotate& o) const {
        return tr("rotate by %1° about %2").arg(short_number(o.angle_deg), vector(o.center));
    }
    QString operator()(const Scale& o) const {
        return tr("scale by %1 about %2").arg(vector(o.factors), vector(o.center));
    }
    QString operator()(const Shear& o) const {
        return tr("shear %1 along %2 by %3").arg(axis_name(o.axis), axis_name(o.along), short_number(o.factor));
    }
    QString operator()(const Expression& o) const {
        QStringList parts;
        for (int axis = 0; axis < 3; ++axis)
            if (o.components[axis])
                parts << QStringLiteral("%1 = %2").arg(axis_name(axis), QString::fromStdString(*o.components[axis]));
        return parts.join(QStringLiteral(",  "));
    }
    QString operator()(const SnapToCircle& o) const {
        return tr("onto the circle of radius %1 about %2").arg(short_number(o.radius), vector(o.center));
    }
    QString operator()(const SnapToSphere& o) const {
        return tr("onto the sphere of radius %1 about %2").arg(short_number(o.radius), vector(o.center));
    }
    QString operator()(const SnapToCylinder& o) const {
        return tr("onto the cylinder of radius %1 about %2, axis %3")
            .arg(short_number(o.radius), vector(o.center), vector(o.axis));
    }
    QString operator()(const SnapToRevolution& o) const {
        return tr("onto a surface of revolution about %1, %2 profile points")
            .arg(axis_name(o.axis), format_count(static_cast<long long>(o.profile.size())));
    }
    QString operator()(const SnapToEllipse& o) const {
        return tr("onto the ellipse %1 × %2 about %3")
            .arg(short_number(o.semi_axis_x), short_number(o.semi_axis_y), vector(o.center));
    }
    QString operator()(const SnapToNaca& o) const {
        return tr("onto the NACA 00%1 profile, chord %2")
            .arg(qRound(o.thickness * 100), 2, 10, QLatin1Char('0'))
            .arg(short_number(o.chord));
    }
};

}  // namespace

QVector<DeformationLine> describe(const Deformation& deformation) {
    QVector<DeformationLine> lines;
    if (const auto* list = std::get_if<OperationList>(&deformation.content)) {
        for (const Operation& operation : list->operations)
            lines.push_back({QString::fromStdString(operation.group), std::visit(Describe{}, operation.kind)});
    } else {
        const auto& table = std::get<NodeTable>(deformation.content);
        const QString count = format_count(static_cast<long long>(table.rows.size()));
        lines.push_back({QString(), table.is_mesh ? tr("boundary positions of a mesh with %1 nodes").arg(count)
                                                  : tr("final positions of %1 nodes").arg(count)});
    }
    return lines;
}

}  // namespace curvewright
