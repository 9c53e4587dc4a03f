#pragma once

#include <QObject>
#include <QStringList>

#include "core/boundary/boundary_rules.h"
#include "core/mesh/mesh_topology.h"

class QComboBox;
class QFormLayout;
class QTreeWidget;
class QTreeWidgetItem;

namespace curvewright {

/// Two rows of a form: what the boundary may do, and, "by group", what each of its named parts may do.
class BoundaryField : public QObject {
    Q_OBJECT

  public:
    /// What the choices say of themselves.
    struct Texts {
        QString tip, fixed, slide, free, by_group;  ///< a tip of "" leaves the choice out
        bool has_interfaces = false;                ///< whether the rules are for interfaces inside the domain, too
    };
    /// name: object name of the choice; the list is called NAME_groups.
    BoundaryField(const QString& name, const Texts& texts, QObject* parent);

    /// Adds the rows at the end of a form.
    void add_to(QFormLayout* form, const QString& label);
    /// Shows or hides them; the list only if it has something to say.
    void set_visible(bool is_visible);

    /// The named parts of a mesh's boundary; null: none. Parts of the same names keep what they may do.
    void list_groups(const MeshTopology* topology);
    BoundaryRules rules() const;
    /// Shows rules. Of groups and a rule for the rest that is not "stays", the rest is told of every group that has no
    /// rule of its own.
    void set_rules(const BoundaryRules& rules);

  signals:
    void changed();

  private:
    enum class Mode { fixed, slide, free, by_group };

    bool eventFilter(QObject* watched, QEvent* event) override;
    void set_mode(QTreeWidgetItem* item, BoundaryMode mode);
    /// A menu at the item's row.
    void offer_modes(QTreeWidgetItem* item);
    static BoundaryMode mode_of(const QTreeWidgetItem* item);
    static QString mode_text(BoundaryMode mode);

    QString name_;
    bool has_interfaces_;
    QFormLayout* form_ = nullptr;
    QComboBox* choice_ = nullptr;
    QTreeWidget* groups_ = nullptr;
    QStringList group_names_, inside_names_;  ///< inside: of interfaces
    bool is_visible_ = true, is_listed_ = false;
};

}  // namespace curvewright
