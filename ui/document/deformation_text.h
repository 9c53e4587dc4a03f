#pragma once

#include <QString>
#include <QVector>

#include "core/deform/deformation.h"

namespace curvewright {

/// One line of a deformation for people: which nodes, and what happens to them.
struct DeformationLine {
    QString group;   ///< name of the group; "" for a node table
    QString action;  ///< "rotate by 30° about (0, 0, 0)"
};

/// What a deformation contains, in the order in which it is applied.
QVector<DeformationLine> describe(const Deformation& deformation);

}  // namespace curvewright
