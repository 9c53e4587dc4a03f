#include "ui/panels/mesh_panel.h"

#include <QDir>
#include <QHeaderView>
#include <QHelpEvent>
#include <QLabel>
#include <QMouseEvent>
#include <QToolTip>
#include <QTreeWidget>
#include <QUndoView>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/jobs/global_check.h"
#include "ui/panels/widgets.h"

namespace curvewright {

MeshPanel::MeshPanel(MeshDocument& document, QWidget* parent) : QWidget(parent), document_(document) {
    file_ = make_label(QString(), "title");
    file_->setObjectName(QStringLiteral("file_name"));
    file_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    elements_ = make_paragraph(QString(), "");
    elements_->setObjectName(QStringLiteral("mesh_elements"));
    nodes_ = make_label(QString(), "muted");
    validity_ = make_paragraph(QString(), "");
    validity_->setObjectName(QStringLiteral("mesh_validity"));
    minimum_ = make_paragraph(QString(), "muted");
    minimum_->setObjectName(QStringLiteral("mesh_minimum"));
    global_ = make_paragraph(QString(), "");
    global_->setObjectName(QStringLiteral("mesh_global"));
    global_->hide();

    groups_ = new QTreeWidget;
    groups_->setObjectName(QStringLiteral("groups"));
    groups_->setColumnCount(2);
    groups_->setHeaderLabels({tr("Name"), tr("Nodes")});
    groups_->headerItem()->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
    groups_->setRootIsDecorated(false);
    groups_->setUniformRowHeights(true);
    groups_->setAllColumnsShowFocus(true);
    groups_->header()->setStretchLastSection(false);
    groups_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    groups_->header()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
    groups_->setToolTip(tr("Click a group to see its elements"));

    history_ = new QUndoView(document.history());
    history_->setObjectName(QStringLiteral("history"));
    history_->setUniformItemSizes(true);
    history_->setTextElideMode(Qt::ElideRight);
    history_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    history_->viewport()->installEventFilter(this);

    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(12, 12, 12, 12);
    layout->setSpacing(2);
    for (QLabel* label : {file_, elements_, nodes_}) layout->addWidget(label);
    layout->addSpacing(4);
    for (QLabel* label : {validity_, minimum_, global_}) layout->addWidget(label);
    layout->addSpacing(8);
    layout->addWidget(make_label(tr("Groups"), "section"));
    layout->addSpacing(2);
    layout->addWidget(groups_, 3);
    layout->addSpacing(8);
    layout->addWidget(make_label(tr("History"), "section"));
    layout->addSpacing(2);
    layout->addWidget(history_, 2);

    connect(&document, &MeshDocument::opened, this, &MeshPanel::show_groups);
    connect(&document, &MeshDocument::state_changed, this, &MeshPanel::show_state);
    connect(&document, &MeshDocument::file_path_changed, this, &MeshPanel::show_file);
    const auto choose = [this](QTreeWidgetItem* item) {
        if (!item) return;
        const GroupLine& line = document_.groups()[groups_->indexOfTopLevelItem(item)];
        if (line.dimension == document_.state().mesh->topology().dimension())
            emit elements_chosen(line.elements);
        else
            emit nodes_chosen(line.nodes);
    };
    connect(groups_, &QTreeWidget::itemClicked, this, choose);
    connect(groups_, &QTreeWidget::itemActivated, this, choose);
    show_file();
    show_state();
}

void MeshPanel::set_history_enabled(bool is_enabled) {
    history_->setEnabled(is_enabled);
}

bool MeshPanel::eventFilter(QObject* watched, QEvent* event) {
    if (watched == history_->viewport() && event->type() == QEvent::ToolTip) {
        const auto* help = static_cast<QHelpEvent*>(event);
        const QModelIndex index = history_->indexAt(help->pos());
        QToolTip::showText(help->globalPos(), history_tip(index.isValid() ? index.row() : -1), history_->viewport(),
                           history_->visualRect(index));
        return true;
    }
    // A click below the last step would only take away the mark of the present one.
    if (watched == history_->viewport() && event->type() == QEvent::MouseButtonPress)
        return !history_->indexAt(static_cast<QMouseEvent*>(event)->position().toPoint()).isValid();
    return QWidget::eventFilter(watched, event);
}

/// Row 0 is the mesh as opened.
QString MeshPanel::history_tip(int row) const {
    QStringList lines;
    if (row == 0) lines << history_->emptyLabel() << QDir::toNativeSeparators(document_.file_path());
    if (row > 0) lines << document_.history()->text(row - 1) << document_.step_details(row - 1);
    lines << tr("Click a step to go to it.");
    lines.removeAll(QString());
    return lines.join(QLatin1Char('\n'));
}

void MeshPanel::show_file() {
    const QString name = document_.file_name();
    file_->setText(name.isEmpty() ? tr("No mesh open") : name);
    file_->setToolTip(QDir::toNativeSeparators(document_.file_path()));
    history_->setEmptyLabel(name.isEmpty() ? QString() : tr("As opened"));
}

void MeshPanel::show_state() {
    const MeshState& state = document_.state();
    for (QLabel* label : {elements_, nodes_, validity_, minimum_}) label->setVisible(state.mesh != nullptr);
    if (!state.mesh) return;
    const MeshTopology& topology = state.mesh->topology();
    elements_->setText(describe_elements(topology));
    nodes_->setText(tr("%1 nodes, %2D").arg(format_count(topology.node_count())).arg(topology.dimension()));
    if (!state.quality) {
        validity_->setText(state.quality_note);
        set_tone(validity_, "warning");
        minimum_->hide();
        return;
    }
    show_quality(state.quality->summary);
}

void MeshPanel::show_global(const GlobalValidityReport* report, bool is_pending, double progress) {
    global_->setVisible(document_.has_mesh() && (report || is_pending));
    if (report) {
        global_->setText(global_text(*report));
        const bool is_known = report->answer != GlobalValidity::undecided;
        set_tone(global_, !is_known ? "warning" : report->answer == GlobalValidity::yes ? "good" : "alarm");
        global_->setToolTip(report->answer == GlobalValidity::yes ? tr("No two elements overlap: this is proved.")
                                                                  : QString::fromStdString(report->reason));
    } else if (is_pending) {
        global_->setText(progress > 0.0 ? tr("looking for overlaps, %1 %").arg(static_cast<int>(100.0 * progress))
                                        : tr("looking for overlaps…"));
        set_tone(global_, "muted");
        global_->setToolTip(tr("Whether elements overlap anywhere is found out in the background."));
    }
}

void MeshPanel::show_quality(const QualitySummary& summary) {
    validity_->setText(describe_validity(summary));
    set_tone(validity_, summary.invalid > 0 ? "alarm" : summary.undecided > 0 ? "warning" : "good");
    minimum_->setText(tr("min scaled Jacobian %1").arg(format_number(summary.min)));
    minimum_->setToolTip(tr("%1, proved: no element is below it").arg(exact_number(summary.min)));
}

void MeshPanel::show_groups() {
    groups_->clear();
    static const QString kinds[] = {tr("points"), tr("curves"), tr("surface"), tr("volume")};
    for (const GroupLine& line : document_.groups()) {
        auto* item = new QTreeWidgetItem(groups_, {line.name, format_count(static_cast<long long>(line.nodes.size()))});
        item->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
        item->setToolTip(0, tr("%1 (%2)").arg(line.name, kinds[qBound(0, line.dimension, 3)]));
    }
}

}  // namespace curvewright
