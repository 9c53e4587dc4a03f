#include "ui/main_window/dialogs.h"

#include <QApplication>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QGridLayout>
#include <QInputDialog>
#include <QKeySequence>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>

#include "ui/main_window/commands.h"
#include "ui/main_window/shortcuts.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("Dialogs", text);
}

UnsavedAnswer ask_recover_with_box(QWidget* parent, const QString& message) {
    QMessageBox box(QMessageBox::Question, tr("Unsaved work"), message, QMessageBox::NoButton, parent);
    const QAbstractButton* recover = box.addButton(tr("Recover"), QMessageBox::AcceptRole);
    const QAbstractButton* discard = box.addButton(tr("Throw away"), QMessageBox::DestructiveRole);
    box.addButton(tr("Later"), QMessageBox::RejectRole);
    box.exec();
    return box.clickedButton() == recover   ? UnsavedAnswer::save
           : box.clickedButton() == discard ? UnsavedAnswer::discard
                                            : UnsavedAnswer::cancel;
}

UnsavedAnswer ask_with_box(QWidget* parent, const QString& file_name) {
    QMessageBox box(QMessageBox::Question, tr("Unsaved changes"),
                    tr("Save the changes to %1 before it is closed?").arg(file_name),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, parent);
    box.setInformativeText(tr("Without saving, the steps of the history are lost."));
    box.setDefaultButton(QMessageBox::Save);
    switch (box.exec()) {
        case QMessageBox::Save:
            return UnsavedAnswer::save;
        case QMessageBox::Discard:
            return UnsavedAnswer::discard;
        default:
            return UnsavedAnswer::cancel;
    }
}

void show_error_box(QWidget* parent, const QString& title, const QString& message) {
    auto* box = new QMessageBox(QMessageBox::Warning, title, message, QMessageBox::Ok, parent);
    box->setObjectName(QStringLiteral("error_box"));
    box->setTextFormat(Qt::PlainText);
    box->setTextInteractionFlags(Qt::TextSelectableByMouse);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->open();
}

}  // namespace

Dialogs Dialogs::standard() {
    Dialogs dialogs;
    dialogs.open_file = [](QWidget* parent, const QString& title, const QString& folder, const QString& filters) {
        return QFileDialog::getOpenFileName(parent, title, folder, filters);
    };
    dialogs.save_file = [](QWidget* parent, const QString& title, const QString& suggestion, const QString& filters,
                           QString& selected) {
        return QFileDialog::getSaveFileName(parent, title, suggestion, filters, &selected);
    };
    dialogs.ask_unsaved = ask_with_box;
    dialogs.ask_recover = ask_recover_with_box;
    dialogs.choose_folder = [](QWidget* parent, const QString& title, const QString& folder) {
        return QFileDialog::getExistingDirectory(parent, title, folder);
    };
    dialogs.ask_text = [](QWidget* parent, const QString& title, const QString& label, const QString& text) {
        return QInputDialog::getText(parent, title, label, QLineEdit::Normal, text);
    };
    dialogs.show_error = show_error_box;
    return dialogs;
}

void show_shortcuts(QWidget* parent, const CommandActions& actions, MouseHabits mouse) {
    const QString name = QStringLiteral("shortcuts_dialog");
    // One is enough; the keys may have changed since.
    delete parent->findChild<QDialog*>(name);
    auto* dialog = new QDialog(parent);
    dialog->setObjectName(name);
    dialog->setWindowTitle(tr("Keyboard and mouse"));
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    auto* page = new QWidget;
    auto* grid = new QGridLayout(page);
    grid->setContentsMargins(12, 12, 12, 12);
    grid->setHorizontalSpacing(24);
    grid->setVerticalSpacing(4);
    int row = 0;
    const auto add = [&](const QString& keys, const QString& text) {
        grid->addWidget(make_label(keys, "title"), row, 0, Qt::AlignTop);
        grid->addWidget(make_paragraph(text, ""), row++, 1);
    };
    const auto begin = [&](const QString& name) {
        if (row > 0) grid->setRowMinimumHeight(row++, 8);
        grid->addWidget(make_label(name, "section"), row++, 0, 1, 2);
    };
    begin(tr("Mouse"));
    add(tr("Wheel"), tr("Zoom, in 2D to the pointer"));
    add(tr("Drag a boundary node"), tr("With the drag tool: move it; the mesh follows"));
    add(tr("Wheel while dragging"), tr("Take more or fewer neighbours along"));
    add(tr("Shift+drag, Ctrl+drag"), tr("With the drag tool: along the normal; without snapping"));
    switch (mouse) {
        case MouseHabits::curvewright:
            add(tr("Drag elsewhere, right drag"), tr("Move a 2D mesh, turn a 3D mesh"));
            add(tr("Shift+drag, middle drag"), tr("Move the mesh"));
            break;
        case MouseHabits::paraview:
            add(tr("Drag elsewhere"), tr("Move a 2D mesh, turn a 3D mesh"));
            add(tr("Middle drag"), tr("Move the mesh"));
            add(tr("Right drag"), tr("Zoom: up comes closer"));
            break;
        case MouseHabits::gmsh:
            add(tr("Drag elsewhere"), tr("Move a 2D mesh, turn a 3D mesh"));
            add(tr("Right drag"), tr("Move the mesh"));
            add(tr("Middle drag"), tr("Zoom: up comes closer"));
            break;
        case MouseHabits::blender:
            add(tr("Middle drag"), tr("Move a 2D mesh, turn a 3D mesh"));
            add(tr("Shift+middle drag"), tr("Move the mesh"));
            add(tr("Ctrl+middle drag"), tr("Zoom: up comes closer"));
            break;
    }
    add(tr("Click"), tr("Tell about the element, the bar of a histogram or the group"));
    begin(tr("Keys of the view and of the panels"));
    for (const FixedKeys& fixed : fixed_keys()) add(fixed_name(fixed), fixed_text(fixed));
    begin(tr("Commands, keys: %1").arg(preset_text(actions.shortcuts().preset())));
    for (const Command& command : commands()) {
        const QList<QKeySequence>& keys = actions.shortcuts().keys(command.id);
        if (!keys.isEmpty()) add(keys_text(keys), help_text(command));
    }
    add(tr("Ctrl+1 … Ctrl+9"), tr("Go to a bookmark of the view"));
    grid->setColumnStretch(1, 1);
    auto* scroll = new QScrollArea;
    scroll->setWidgetResizable(true);
    scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    scroll->setWidget(page);
    auto* change = new QPushButton(tr("Change…"));
    change->setObjectName(QStringLiteral("change_shortcuts"));
    change->setToolTip(tr("Choose other keys, or those of another program"));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    buttons->addButton(change, QDialogButtonBox::ActionRole);
    auto* layout = new QVBoxLayout(dialog);
    layout->addWidget(scroll);
    layout->addWidget(buttons);
    QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
    QObject::connect(change, &QPushButton::clicked, dialog, [dialog, action = actions[CommandId::preferences]] {
        dialog->close();
        action->trigger();
    });
    scroll->setFocus();
    dialog->resize(760, 600);
    dialog->show();
}

void show_about(QWidget* parent) {
    auto* box = new QMessageBox(
        QMessageBox::NoIcon, tr("About Curvewright"),
        tr("Curvewright %1\n\nViewer, editor and untangler of curved high-order finite-element meshes.\n"
           "Colours are certified scaled Jacobians: an element that is called valid is proved to be valid.")
            .arg(QCoreApplication::applicationVersion()),
        QMessageBox::Ok, parent);
    box->setIconPixmap(QApplication::windowIcon().pixmap(64));
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->open();
}

}  // namespace curvewright
