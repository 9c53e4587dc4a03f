#include "ui/main_window/preferences_dialog.h"

#include <QAction>
#include <QCheckBox>
#include <QDesktopServices>
#include <QDialogButtonBox>
#include <QDir>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTabWidget>
#include <QUrl>
#include <QVBoxLayout>

#include "ui/document/journal.h"
#include "ui/main_window/shortcut_page.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

const CommandId theme_commands[] = {CommandId::theme_system, CommandId::theme_light, CommandId::theme_dark};

QWidget* make_page(QFormLayout* form) {
    auto* page = new QWidget;
    auto* column = new QVBoxLayout(page);
    column->setContentsMargins(16, 16, 16, 16);
    column->addLayout(form);
    column->addStretch();
    return page;
}

QPushButton* make_small_button(const QString& text, const char* object_name, const QString& tip) {
    auto* button = new QPushButton(text);
    button->setObjectName(QLatin1String(object_name));
    button->setToolTip(tip);
    button->setAutoDefault(false);
    return button;
}

}  // namespace

PreferencesDialog::PreferencesDialog(const CommandActions& actions, EditState& edit, RecentFiles& recent,
                                     QWidget* parent)
    : QDialog(parent), actions_(actions), edit_(edit), recent_(recent), preferences_(Preferences::load()) {
    setObjectName(QStringLiteral("preferences_dialog"));
    setWindowTitle(tr("Preferences"));
    setAttribute(Qt::WA_DeleteOnClose);
    pages_ = new QTabWidget;
    pages_->setObjectName(QStringLiteral("preferences_pages"));
    pages_->setDocumentMode(true);
    add_page(make_general(), QStringLiteral("general"), tr("General"));
    add_page(make_view(), QStringLiteral("view"), tr("View"));
    add_page(make_editing(), QStringLiteral("editing"), tr("Editing"));
    add_page(make_keys(), QStringLiteral("keys"), tr("Keys and mouse"));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    // Enter belongs to the field that the keyboard is in.
    buttons->button(QDialogButtonBox::Close)->setAutoDefault(false);
    auto* foot = new QHBoxLayout;
    foot->setContentsMargins(16, 0, 16, 12);
    foot->addWidget(make_label(tr("Changes count at once."), "muted"), 1);
    foot->addWidget(buttons);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 4, 0, 0);
    layout->addWidget(pages_, 1);
    layout->addLayout(foot);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
    resize(600, 560);
}

void PreferencesDialog::add_page(QWidget* page, const QString& name, const QString& title) {
    page->setObjectName(name + QStringLiteral("_page"));
    pages_->addTab(page, title);
}

void PreferencesDialog::show_page(const QString& name) {
    for (int i = 0; i < pages_->count(); ++i)
        if (pages_->widget(i)->objectName() == name + QStringLiteral("_page")) pages_->setCurrentIndex(i);
}

void PreferencesDialog::change(const std::function<void(Preferences&)>& set) {
    set(preferences_);
    preferences_.store();
    emit changed();
}

QWidget* PreferencesDialog::make_check(const char* object_name, const QString& text, const QString& tip,
                                       bool Preferences::*value) {
    auto* box = new QCheckBox(text);
    box->setObjectName(QLatin1String(object_name));
    box->setToolTip(tip);
    box->setChecked(preferences_.*value);
    connect(box, &QCheckBox::toggled, this,
            [this, value](bool is_on) { change([&](Preferences& p) { p.*value = is_on; }); });
    return box;
}

QWidget* PreferencesDialog::make_general() {
    auto* look = make_choice("preferred_theme", tr("The colours of the window."),
                             {{tr("As the system"), 0, tr("light or dark, as the system is.")},
                              {tr("Light"), 1, tr("dark text on light ground.")},
                              {tr("Dark"), 2, tr("light text on dark ground.")}});
    for (int i = 0; i < 3; ++i)
        if (actions_[theme_commands[i]]->isChecked()) look->setCurrentIndex(i);
    connect(look, &QComboBox::currentIndexChanged, this, [this](int i) { actions_[theme_commands[i]]->trigger(); });
    for (int i = 0; i < 3; ++i)
        connect(actions_[theme_commands[i]], &QAction::toggled, look, [look, i](bool is_on) {
            if (is_on) look->setCurrentIndex(i);
        });

    auto* start = make_choice("preferred_start", tr("What is there when the program starts without a mesh."),
                              {{tr("Start page"), int(StartAction::start_page), tr("recent files and samples.")},
                               {tr("Last mesh"), int(StartAction::last_mesh), tr("the file that was opened last.")}});
    start->setCurrentIndex(start->findData(int(preferences_.start)));
    connect(start, &QComboBox::currentIndexChanged, this,
            [this, start] { change([&](Preferences& p) { p.start = chosen<StartAction>(start); }); });

    auto* count = new QSpinBox;
    count->setObjectName(QStringLiteral("recent_count"));
    count->setRange(0, Preferences::most_recent);
    count->setValue(preferences_.recent_count);
    count->setToolTip(tr("How many files are remembered under File > Open recent. 0: none."));
    connect(count, &QSpinBox::valueChanged, this, [this](int value) {
        change([&](Preferences& p) { p.recent_count = value; });
        emit recent_.changed();
    });
    auto* clear = make_small_button(tr("Clear the list"), "clear_recent", tr("Forget the files opened so far"));
    connect(clear, &QPushButton::clicked, &recent_, &RecentFiles::clear);
    const auto can_clear = [this, clear] { clear->setEnabled(!recent_.paths().isEmpty()); };
    connect(&recent_, &RecentFiles::changed, clear, can_clear);
    can_clear();
    auto* files = new QHBoxLayout;
    files->setSpacing(8);
    files->addWidget(count);
    files->addWidget(clear);
    files->addStretch();

    auto* folder = new QHBoxLayout;
    folder->setSpacing(8);
    auto* path = make_label(QDir::toNativeSeparators(Journal::standard_folder()), "muted");
    path->setObjectName(QStringLiteral("journal_folder"));
    path->setTextInteractionFlags(Qt::TextSelectableByMouse);
    path->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    path->setToolTip(path->text());
    auto* show = make_small_button(tr("Show"), "show_journal_folder", tr("Open the folder in the file manager"));
    connect(show, &QPushButton::clicked, this,
            [] { QDesktopServices::openUrl(QUrl::fromLocalFile(Journal::standard_folder())); });
    folder->addWidget(path, 1);
    folder->addWidget(show);

    QFormLayout* form = make_form();
    form->addRow(tr("Theme"), look);
    form->addRow(tr("At the start"), start);
    form->addRow(tr("Recent files"), files);
    form->addRow(
        make_check("keeps_work", tr("Keep unsaved work for after a crash"),
                   tr("After every step the mesh is written to the folder below; it is gone as soon as nothing "
                      "would be lost"),
                   &Preferences::keeps_work));
    form->addRow(tr("Folder"), folder);
    align_labels(form);
    return make_page(form);
}

QWidget* PreferencesDialog::make_view() {
    QFormLayout* form = make_form();
    auto* as_left = static_cast<QCheckBox*>(
        make_check("remembers_drawing", tr("Start with edges, nodes and legend as they were left"),
                   tr("Otherwise always as chosen here"), &Preferences::remembers_drawing));
    form->addRow(as_left);
    const struct {
        const char* name;
        QString text, tip;
        bool Preferences::*value;
    } checks[] = {
        {"starts_with_edges", tr("Edges"), tr("Start with the edges of the elements"), &Preferences::starts_with_edges},
        {"starts_with_nodes", tr("Nodes"), tr("Start with the nodes"), &Preferences::starts_with_nodes},
        {"starts_with_legend", tr("Legend"), tr("Start with the scale of colours"), &Preferences::starts_with_legend}};
    auto* row = new QHBoxLayout;
    row->setContentsMargins(20, 0, 0, 0);
    row->setSpacing(16);
    for (const auto& check : checks) {
        QWidget* box = make_check(check.name, check.text, check.tip, check.value);
        box->setEnabled(!as_left->isChecked());
        connect(as_left, &QCheckBox::toggled, box, &QWidget::setDisabled);
        row->addWidget(box);
    }
    row->addStretch();
    form->addRow(row);
    form->addRow(make_check("remembers_tool", tr("Start with the tool that was used last"),
                            tr("For flat meshes and for solids each. Otherwise flat meshes start with the drag tool, "
                               "solids with looking around"),
                            &Preferences::remembers_tool));
    return make_page(form);
}

QWidget* PreferencesDialog::make_editing() {
    auto* unit = make_choice("preferred_unit", tr("What a press on the boundary takes hold of."),
                             {{tr("A node"), int(GrabUnit::node), tr("the node under the mouse.")},
                              {tr("A side"), int(GrabUnit::side), tr("the smooth part of the boundary.")},
                              {tr("A whole boundary"), int(GrabUnit::boundary), tr("all that hangs together.")}});
    auto* soft = new QCheckBox(tr("Take neighbours along"));
    soft->setObjectName(QStringLiteral("preferred_soft"));
    soft->setToolTip(tr("Boundary nodes near those that are dragged follow (proportional editing)"));
    auto* falloff = make_choice("preferred_falloff", tr("How the share falls from the node in hand to the radius."),
                                {{tr("Smooth"), int(Falloff::smooth), tr("level at both ends.")},
                                 {tr("Sphere"), int(Falloff::sphere), tr("like a ball pressed from below.")},
                                 {tr("Root"), int(Falloff::root), tr("full and blunt.")},
                                 {tr("Linear"), int(Falloff::linear), tr("a tent.")},
                                 {tr("Sharp"), int(Falloff::sharp), tr("a thin peak.")}});
    auto* along = new QCheckBox(tr("Measured along the boundary"));
    along->setObjectName(QStringLiteral("preferred_along"));
    along->setToolTip(tr("Otherwise as the crow flies: the far side of a thin part moves too"));
    QDoubleSpinBox* radius = make_number("soft_radius_percent", 0.1, 100.0, 1.0, 1, preferences_.soft_radius_percent);
    radius->setSuffix(tr(" % of the mesh"));
    radius->setToolTip(tr("How far a drag reaches in a mesh just opened, as a part of its diagonal"));
    auto* what = make_choice("preferred_select", tr("What a click, a box or a lasso selects."),
                             {{tr("Boundary nodes"), int(SelectWhat::boundary_nodes), tr("nodes of the boundary.")},
                              {tr("All nodes"), int(SelectWhat::nodes), tr("interior nodes too.")},
                              {tr("Elements"), int(SelectWhat::elements), tr("whole elements.")}});
    auto* shape = make_choice("preferred_shape", tr("What a drag with the select tool draws."),
                              {{tr("Box"), 0, tr("a rectangle.")}, {tr("Lasso"), 1, tr("any outline.")}});

    const auto show = [this, unit, soft, falloff, along, what, shape] {
        const EditSettings& settings = edit_.settings();
        const auto choose = [](QComboBox* box, int value) {
            const QSignalBlocker blocker(box);
            box->setCurrentIndex(box->findData(value));
        };
        choose(unit, int(settings.unit));
        choose(falloff, int(settings.soft.falloff));
        choose(what, int(settings.select.what));
        choose(shape, settings.select.is_lasso ? 1 : 0);
        const QSignalBlocker soft_blocker(soft), along_blocker(along);
        soft->setChecked(settings.is_soft);
        along->setChecked(settings.soft.follows_boundary);
    };
    show();
    connect(&edit_, &EditState::settings_changed, unit, show);
    const auto read = [this, unit, soft, falloff, along, what, shape] {
        EditSettings settings = edit_.settings();
        settings.unit = chosen<GrabUnit>(unit);
        settings.is_soft = soft->isChecked();
        settings.soft.falloff = chosen<Falloff>(falloff);
        settings.soft.follows_boundary = along->isChecked();
        settings.select.what = chosen<SelectWhat>(what);
        settings.select.is_lasso = shape->currentData().toInt() == 1;
        edit_.set_settings(settings);
    };
    for (QComboBox* box : {unit, falloff, what, shape}) connect(box, &QComboBox::currentIndexChanged, this, read);
    for (QCheckBox* box : {soft, along}) connect(box, &QCheckBox::toggled, this, read);
    connect(radius, &QDoubleSpinBox::valueChanged, this,
            [this](double value) { change([&](Preferences& p) { p.soft_radius_percent = value; }); });

    QFormLayout* form = make_form();
    form->addRow(make_label(tr("The same as on the tabs Edit and Inspect; kept for the next start."), "muted"));
    form->addRow(tr("A press takes"), unit);
    form->addRow(soft);
    form->addRow(tr("Radius at first"), radius);
    form->addRow(tr("Falloff"), falloff);
    form->addRow(along);
    form->addRow(tr("Selects"), what);
    form->addRow(tr("By"), shape);
    align_labels(form);
    return make_page(form);
}

QWidget* PreferencesDialog::make_keys() {
    auto* mouse = make_choice(
        "preferred_mouse", tr("Which button moves the view how. Tools keep the left button."),
        {{tr("Curvewright"), int(MouseHabits::curvewright), tr("left or right turns, middle or Shift moves.")},
         {tr("Like ParaView"), int(MouseHabits::paraview), tr("left turns, middle moves, right zooms.")},
         {tr("Like Gmsh"), int(MouseHabits::gmsh), tr("left turns, right moves, middle zooms.")},
         {tr("Like Blender"), int(MouseHabits::blender),
          tr("middle turns, Shift and middle moves, Ctrl and middle zooms.")}});
    mouse->setCurrentIndex(mouse->findData(int(preferences_.mouse)));
    connect(mouse, &QComboBox::currentIndexChanged, this,
            [this, mouse] { change([&](Preferences& p) { p.mouse = chosen<MouseHabits>(mouse); }); });
    QFormLayout* form = make_form();
    form->addRow(tr("Mouse"), mouse);
    form->addRow(make_check("wheel_is_reversed", tr("Turn the wheel the other way round"),
                            tr("Towards you comes closer, away from you goes back"), &Preferences::wheel_is_reversed));
    auto* keys = new ShortcutPage(actions_.shortcuts());
    form->addRow(tr("Keys"), keys->preset_box());
    align_labels(form);
    auto* page = new QWidget;
    auto* column = new QVBoxLayout(page);
    column->setContentsMargins(16, 16, 16, 8);
    column->setSpacing(8);
    column->addLayout(form);
    column->addWidget(keys, 1);
    return page;
}

}  // namespace curvewright
