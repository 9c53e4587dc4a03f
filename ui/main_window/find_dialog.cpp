#include "ui/main_window/find_dialog.h"

#include <QLabel>
#include <QLineEdit>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/document/tag_query.h"
#include "ui/panels/widgets.h"

namespace curvewright {

FindDialog::FindDialog(EditState& edit, QWidget* parent)
    : QDialog(parent, Qt::Dialog | Qt::FramelessWindowHint), edit_(edit) {
    setObjectName(QStringLiteral("find_dialog"));
    setAttribute(Qt::WA_DeleteOnClose);
    setAttribute(Qt::WA_StyledBackground);
    setWindowTitle(tr("Find node or element"));
    tags_ = new QLineEdit;
    tags_->setObjectName(QStringLiteral("find_tags"));
    tags_->setPlaceholderText(tr("Tags: 12, 40-52 for nodes, e7 for elements"));
    tags_->setAccessibleName(windowTitle());
    answer_ = make_paragraph(QString(), "muted");
    answer_->setObjectName(QStringLiteral("find_answer"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(12, 12, 12, 12);
    layout->setSpacing(8);
    layout->addWidget(make_label(windowTitle(), "title"));
    layout->addWidget(tags_);
    layout->addWidget(answer_);
    connect(tags_, &QLineEdit::textChanged, this, &FindDialog::tell);
    connect(tags_, &QLineEdit::returnPressed, this, &FindDialog::take);
    tell();
    resize(440, sizeHint().height());
    const QRect window = parent->window()->geometry();
    move(window.center().x() - width() / 2, window.top() + 96);
}

void FindDialog::tell() {
    const MeshTopology& topology = edit_.document().state().mesh->topology();
    const TagQuery query = find_tags(topology, tags_->text());
    QStringList parts;
    const auto nodes = static_cast<long long>(query.nodes.size()),
               elements = static_cast<long long>(query.elements.size());
    if (nodes > 0) parts << (nodes == 1 ? tr("1 node") : tr("%1 nodes").arg(format_count(nodes)));
    if (elements > 0) parts << (elements == 1 ? tr("1 element") : tr("%1 elements").arg(format_count(elements)));
    QString text = parts.join(QStringLiteral(", "));
    if (!text.isEmpty()) text = tr("Enter selects %1.").arg(text);
    if (!query.problem.isEmpty()) text = text.isEmpty() ? query.problem : query.problem + QLatin1Char(' ') + text;
    if (text.isEmpty())
        text = tr("The mesh has %1 nodes and %2 elements.")
                   .arg(format_count(topology.node_count()), format_count(topology.element_count()));
    set_tone(answer_, query.problem.isEmpty() ? "muted" : "warning");
    answer_->setText(text);
}

void FindDialog::take() {
    TagQuery query = find_tags(edit_.document().state().mesh->topology(), tags_->text());
    if (query.nodes.empty() && query.elements.empty()) return;
    edit_.select(std::move(query.nodes), std::move(query.elements));
    emit found();
    close();
}

}  // namespace curvewright
