// What the colours of the views show.

#include <QAction>
#include <QLabel>
#include <QPointer>

#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/clip_bar.h"
#include "ui/panels/color_bar.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/selection_panel.h"
#include "ui/panels/worst_table.h"

namespace curvewright {

void MainWindow::connect_colors() {
    QAction* action = actions_[CommandId::colors];
    connect(action, &QAction::toggled, this, [this](bool is_on) {
        color_bar_->setVisible(is_on && document_.has_mesh());
        place_bars();
        if (!is_on) view_->setFocus();
    });
    connect(color_bar_, &ColorBar::close_requested, action, [action] { action->setChecked(false); });
    connect(view_, &MeshView::legend_clicked, action, &QAction::toggle);
    connect(color_bar_, &ColorBar::changed, this, &MainWindow::update_coloring);
    connect(&document_, &MeshDocument::opened, color_bar_, &ColorBar::refresh);
    connect(&document_, &MeshDocument::state_changed, this, &MainWindow::follow_coloring);
    connect(actions_[CommandId::compare], &QAction::toggled, this, &MainWindow::follow_coloring);
    connect(&element_numbers_, &ElementNumbers::computed, this,
            [this](const std::shared_ptr<const FieldArray>& now, const std::shared_ptr<const FieldArray>& before) {
                numbers_now_ = now;
                numbers_before_ = before;
                show_coloring();
            });
    update_coloring();
}

void MainWindow::update_coloring() {
    const ColorScale& scale = color_bar_->quality_scale();
    quality_panel_->set_scale(scale);
    worst_table_->set_scale(scale);
    selection_panel_->set_scale(scale);
    numbers_now_.reset();
    numbers_before_.reset();
    show_coloring();
    follow_coloring();
    place_bars();
}

void MainWindow::follow_coloring() {
    const ColorSetting::Kind kind = color_bar_->setting().kind;
    const bool is_computed = kind == ColorSetting::Kind::size || kind == ColorSetting::Kind::shape;
    if (is_computed && document_.has_mesh()) {
        const bool has_before = actions_[CommandId::compare]->isChecked();
        element_numbers_.request(
            kind == ColorSetting::Kind::size ? ElementNumbers::Kind::size : ElementNumbers::Kind::shape,
            document_.state().mesh, has_before ? document_.before().mesh : nullptr, document_.original().mesh);
        color_bar_->show_waiting();
        return;
    }
    element_numbers_.cancel();
    // The range may be another one now, and holds for both views.
    if (kind == ColorSetting::Kind::distance_moved || kind == ColorSetting::Kind::array) show_coloring();
}

void MainWindow::show_coloring() {
    const ColorSetting& setting = color_bar_->setting();
    Coloring coloring;
    coloring.map = setting.map;
    coloring.is_reversed = setting.is_reversed;
    coloring.lower = setting.lower;
    coloring.upper = setting.upper;
    coloring.title = setting.title.toStdString();
    coloring.detail = setting.detail.toStdString();
    coloring.component = setting.component;
    switch (setting.kind) {
        case ColorSetting::Kind::scaled_jacobian:
            break;
        case ColorSetting::Kind::plain:
            coloring.source = Coloring::Source::plain;
            break;
        case ColorSetting::Kind::distance_moved:
            coloring.source = Coloring::Source::distance_moved;
            if (const auto& opened = document_.original().mesh)
                coloring.reference = std::shared_ptr<const Coordinates>(opened, &opened->coordinates());
            break;
        case ColorSetting::Kind::array:
            coloring.source = Coloring::Source::array;
            coloring.array = std::shared_ptr<const FieldArray>(
                document_.fields(), &(*document_.fields())[static_cast<std::size_t>(setting.array)]);
            break;
        case ColorSetting::Kind::shape:
            if (!coloring.lower) coloring.lower = 0.0;
            if (!coloring.upper) coloring.upper = 1.0;
            [[fallthrough]];
        case ColorSetting::Kind::size:
            coloring.source = Coloring::Source::array;
            coloring.array = numbers_now_;
            coloring.is_of_one_state = true;
            break;
    }
    view_->set_coloring(coloring);
    const ColorScale& shown = view_->shown_scale();
    color_bar_->show_range(shown.lower, shown.upper);
    // The same colour means the same number in both views.
    coloring.lower = shown.lower;
    coloring.upper = shown.upper;
    const bool is_computed = setting.kind == ColorSetting::Kind::size || setting.kind == ColorSetting::Kind::shape;
    if (is_computed) coloring.array = numbers_before_;
    before_view_->set_coloring(coloring);
}

void MainWindow::place_bars() {
    // Beside each other the views are narrow: the bars go where no legend is.
    QWidget* view = actions_[CommandId::compare]->isChecked() && document_.has_mesh() ? before_view_ : view_;
    for (QWidget* bar : {static_cast<QWidget*>(clip_bar_), static_cast<QWidget*>(color_bar_)}) {
        if (bar->parentWidget() == view) continue;
        const bool is_shown = !bar->isHidden();
        QPointer<QWidget> focus = bar->isAncestorOf(focusWidget()) ? focusWidget() : nullptr;
        bar->setParent(view);
        bar->setVisible(is_shown);
        if (focus) focus->setFocus();
    }
    int top = 12;
    for (QLabel* name : view->findChildren<QLabel*>(QStringLiteral("view_name")))
        if (!name->isHidden()) top = name->geometry().bottom() + 9;
    constexpr int margin = 12, room_for_slider = 80;
    for (QWidget* bar : {static_cast<QWidget*>(clip_bar_), static_cast<QWidget*>(color_bar_)}) {
        bar->adjustSize();
        if (bar == clip_bar_) {
            const QSize least = bar->minimumSizeHint();
            bar->resize(std::clamp(view->width() - 2 * margin, least.width(), least.width() + room_for_slider),
                        least.height());
        }
        bar->move(margin, top);
        if (!bar->isHidden()) top = bar->geometry().bottom() + 9;
    }
}

}  // namespace curvewright
