#include "ui/panels/quality_panel.h"

#include <algorithm>
#include <numeric>

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSettings>

#include "ui/document/mesh_text.h"
#include "ui/document/number_format.h"
#include "ui/panels/histogram_widget.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

QString figures_text(const QualitySummary& summary) {
    return QualityPanel::tr("min %1   mean %2   max %3")
        .arg(format_number(summary.min), format_number(summary.mean), format_number(summary.max));
}

std::optional<QualityPanel::Qualities> qualities_of(const MeshState& state) {
    if (!state.quality) return std::nullopt;
    return state.quality->elements;
}

}  // namespace

QualityPanel::QualityPanel(MeshDocument& document, const Theme& theme, QWidget* parent)
    : QWidget(parent), document_(document), theme_(theme) {
    reference_ = new QComboBox;
    reference_->setObjectName(QStringLiteral("compare_with"));
    reference_->addItems({tr("the last step"), tr("the mesh as opened")});
    reference_->setToolTip(tr("What the present mesh is compared with"));
    logarithmic_ =
        make_check("log_counts", "log_counts", tr("Log counts"),
                   tr("Draw the counts logarithmically, so that a few bad elements show among many good ones"), true);
    overlay_ = make_check("overlay_bars", "overlay", tr("Overlay"),
                          tr("Draw what was before as a line over the bars of now, instead of beside them"), false);
    has_groups_ = make_check("show_group_figures", "groups", tr("Groups"),
                             tr("How the elements of every physical group were and are"), false);
    auto* write = new QPushButton(tr("Export…"));
    write->setObjectName(QStringLiteral("export_histogram"));
    write->setToolTip(tr("Write bars and figures as a table (CSV) or the drawing as SVG or PNG"));

    before_ = make_side(QStringLiteral("before"), tr("Before"));
    after_ = make_side(QStringLiteral("after"), tr("Now"));
    table_ = new GroupTable(theme_);

    auto* head = new QHBoxLayout;
    head->setSpacing(12);
    head->addWidget(make_label(tr("Compared with"), "muted"));
    head->addWidget(reference_);
    head->addStretch();
    for (QCheckBox* box : {logarithmic_, overlay_, has_groups_}) head->addWidget(box);
    head->addWidget(write);
    grid_ = new QGridLayout;
    grid_->setHorizontalSpacing(24);
    grid_->setVerticalSpacing(2);
    grid_->setRowStretch(0, 1);
    grid_->addWidget(before_.histogram, 0, 0);
    grid_->addWidget(after_.histogram, 0, 1);
    grid_->addWidget(table_, 0, 2, 2, 1);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(12, 6, 12, 8);
    layout->setSpacing(4);
    layout->addLayout(head);
    layout->addLayout(grid_, 1);

    connect(&document, &MeshDocument::opened, this, [this] {
        find_groups();
        refresh();
    });
    connect(&document, &MeshDocument::state_changed, this, &QualityPanel::refresh);
    connect(reference_, &QComboBox::currentIndexChanged, this, &QualityPanel::refresh);
    connect(logarithmic_, &QCheckBox::toggled, this, &QualityPanel::refresh);
    for (QCheckBox* box : {overlay_, has_groups_})
        connect(box, &QCheckBox::toggled, this, [this] {
            arrange();
            refresh();
        });
    connect(&theme, &Theme::changed, this, &QualityPanel::refresh);
    connect(write, &QPushButton::clicked, this, &QualityPanel::export_requested);
    for (const Side& side : {before_, after_})
        connect(side.histogram, &HistogramWidget::elements_taken, this, &QualityPanel::elements_chosen);
    connect(table_, &GroupTable::elements_taken, this, &QualityPanel::elements_chosen);
    find_groups();
    arrange();
    refresh();
}

QCheckBox* QualityPanel::make_check(const char* object_name, const char* setting, const QString& text,
                                    const QString& tip, bool is_on) {
    const QString key = QStringLiteral("quality/") + QLatin1String(setting);
    auto* box = new QCheckBox(text);
    box->setObjectName(QLatin1String(object_name));
    box->setToolTip(tip);
    box->setChecked(QSettings().value(key, is_on).toBool());
    connect(box, &QCheckBox::toggled, this, [key](bool is_checked) { QSettings().setValue(key, is_checked); });
    return box;
}

QualityPanel::Side QualityPanel::make_side(const QString& object_name, const QString& title) {
    Side side;
    side.histogram = new HistogramWidget(theme_);
    side.histogram->setObjectName(object_name + QStringLiteral("_histogram"));
    side.title = make_label(title, "muted");
    side.figures = make_label(QString(), "");
    side.figures->setObjectName(object_name + QStringLiteral("_figures"));
    side.figures->setTextInteractionFlags(Qt::TextSelectableByMouse);
    side.validity = make_label(QString(), "");
    side.validity->setObjectName(object_name + QStringLiteral("_validity"));
    side.foot = new QWidget;
    auto* foot = new QHBoxLayout(side.foot);
    foot->setContentsMargins(0, 0, 0, 0);
    foot->setSpacing(12);
    foot->addWidget(side.title);
    foot->addWidget(side.figures);
    foot->addStretch();
    foot->addWidget(side.validity);
    return side;
}

void QualityPanel::find_groups() {
    groups_.clear();
    if (!document_.has_mesh()) return;
    const MeshTopology& topology = document_.state().mesh->topology();
    IndexSet all(static_cast<std::size_t>(topology.element_count()));
    std::iota(all.begin(), all.end(), 0);
    groups_.push_back({tr("all elements"), std::move(all), true, {}, {}});
    for (const GroupLine& line : document_.groups())
        if (!line.elements.empty()) {
            IndexSet elements = line.elements;
            std::sort(elements.begin(), elements.end());
            elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
            groups_.push_back({line.name, std::move(elements), false, {}, {}});
        }
}

void QualityPanel::arrange() {
    const bool is_overlay = overlay_->isChecked(), has_groups = has_groups_->isChecked();
    for (const Side& side : {before_, after_}) grid_->removeWidget(side.foot);
    grid_->removeWidget(after_.histogram);
    if (is_overlay) {
        grid_->addWidget(after_.histogram, 0, 0, 1, 2);
    } else {
        grid_->addWidget(after_.histogram, 0, 1);
    }
    grid_->addWidget(before_.foot, 1, 0);
    grid_->addWidget(after_.foot, 1, 1);
    for (const int column : {0, 1}) grid_->setColumnStretch(column, 1);
    before_.histogram->setVisible(!is_overlay);
    before_.histogram->set_title(tr("Before"));
    after_.histogram->set_title(is_overlay ? tr("□ Before   ■ Now") : tr("Now"));
    // The table's first line says the same.
    for (const Side& side : {before_, after_}) {
        side.title->setVisible(is_overlay);
        side.foot->setVisible(!has_groups);
    }
    table_->setVisible(has_groups);
}

void QualityPanel::show_side(Side& side, std::optional<Qualities> elements) {
    side.summary = elements ? summary_of(*elements) : QualitySummary();
    side.histogram->set_elements(elements, side.summary.min);
    if (!elements) {
        side.figures->clear();
        side.validity->clear();
        return;
    }
    const QualitySummary& summary = side.summary;
    side.figures->setText(figures_text(summary));
    side.figures->setToolTip(
        tr("Scaled Jacobian: min %1, mean %2, max %3")
            .arg(exact_number(summary.min), exact_number(summary.mean), exact_number(summary.max)));
    side.validity->setText(describe_validity(summary));
    side.validity->setToolTip(
        tr("%1 valid, %2 tangled, %3 undecided")
            .arg(format_count(summary.valid), format_count(summary.invalid), format_count(summary.undecided)));
    set_tone(side.validity, summary.invalid > 0 ? "alarm" : summary.undecided > 0 ? "warning" : "good");
}

void QualityPanel::show_both(std::optional<Qualities> before, std::optional<Qualities> now, Index least_limit) {
    show_side(before_, before);
    show_side(after_, now);
    const HistogramBars &bars_before = before_.histogram->bars(), &bars_now = after_.histogram->bars();
    const Index limit = std::max({least_limit, bars_before.highest(), bars_now.highest()});
    for (const Side& side : {before_, after_}) side.histogram->set_scale(limit, logarithmic_->isChecked());
    const bool has_outline = overlay_->isChecked() && before.has_value();
    after_.histogram->set_outline(has_outline ? std::optional(bars_before) : std::nullopt);
    for (GroupFigures& group : groups_) {
        group.before = before ? summary_of(*before, group.elements) : QualitySummary();
        group.now = now ? summary_of(*now, group.elements) : QualitySummary();
    }
    if (has_groups_->isChecked()) table_->show_groups(groups_, before.has_value(), now.has_value());
}

void QualityPanel::show_live(Qualities now, std::optional<Qualities> before) {
    if (reference_->currentIndex() == 1)
        before = qualities_of(document_.original());
    else if (!before)
        before = qualities_of(document_.state());
    // A scale that shrinks meanwhile would hide what moves.
    show_both(before, now, after_.histogram->limit());
}

void QualityPanel::refresh() {
    const MeshState& reference = reference_->currentIndex() == 1 ? document_.original() : document_.before();
    show_both(qualities_of(reference), qualities_of(document_.state()), 1);
    before_.histogram->setToolTip(reference.quality ? QString() : reference.quality_note);
    after_.histogram->setToolTip(document_.state().quality_note);
    emit refreshed();
}

void QualityPanel::set_selected(const IndexSet& elements) {
    for (const Side& side : {before_, after_}) side.histogram->set_selected(elements);
}

void QualityPanel::set_scale(const ColorScale& scale) {
    for (const Side& side : {before_, after_}) side.histogram->set_colors(scale);
}

QualityComparison QualityPanel::comparison() const {
    const auto side_of = [](const Side& side) {
        const QString figures = side.histogram->has_data() ? figures_text(side.summary) + QStringLiteral("   ") +
                                                                 describe_validity(side.summary)
                                                           : QString();
        return QualityComparison::Side{side.title->text(), figures, side.histogram->drawing()};
    };
    return {side_of(before_), side_of(after_), overlay_->isChecked(), groups_};
}

}  // namespace curvewright
