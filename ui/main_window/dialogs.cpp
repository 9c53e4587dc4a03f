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

void show_shortcuts(QWidget* parent) {
    auto* dialog = new QDialog(parent);
    dialog->setObjectName(QStringLiteral("shortcuts_dialog"));
    dialog->setWindowTitle(tr("Keyboard and mouse"));
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    auto* page = new QWidget;
    auto* grid = new QGridLayout(page);
    grid->setHorizontalSpacing(24);
    grid->setVerticalSpacing(4);
    int row = 0;
    const auto add = [&](const QString& keys, const QString& text) {
        grid->addWidget(make_label(keys, "title"), row, 0);
        grid->addWidget(make_label(text, ""), row++, 1);
    };
    grid->addWidget(make_label(tr("Mouse"), "section"), row++, 0, 1, 2);
    add(tr("Wheel"), tr("Zoom, in 2D to the pointer"));
    add(tr("Drag a boundary node"), tr("With the drag tool: move it; the mesh follows"));
    add(tr("Wheel while dragging"), tr("Take more or fewer neighbours along"));
    add(tr("X, Y, Z, N while dragging"), tr("Keep to an axis or to the normal; again: free"));
    add(tr("Shift+drag, Ctrl+drag"), tr("With the drag tool: along the normal; without snapping"));
    add(tr("Drag elsewhere, right drag"), tr("Move a 2D mesh, turn a 3D mesh"));
    add(tr("Shift+drag, middle drag"), tr("Move the mesh"));
    add(tr("Click"), tr("Tell about the element, the bar of a histogram or the group"));
    grid->setRowMinimumHeight(row++, 8);
    grid->addWidget(make_label(tr("Keyboard"), "section"), row++, 0, 1, 2);
    for (const Command& command : commands()) {
        QStringList keys;
        for (const QString& key :
             QString::fromLatin1(command.shortcuts).split(QStringLiteral("; "), Qt::SkipEmptyParts))
            keys << QKeySequence(key, QKeySequence::PortableText).toString(QKeySequence::NativeText);
        if (!keys.isEmpty()) add(keys.join(tr(" or ")), help_text(command));
    }
    add(tr("Ctrl+1 … Ctrl+9"), tr("Go to a bookmark of the view"));
    grid->setColumnStretch(1, 1);
    auto* scroll = new QScrollArea;
    scroll->setWidgetResizable(true);
    scroll->setWidget(page);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    auto* layout = new QVBoxLayout(dialog);
    layout->addWidget(scroll);
    layout->addWidget(buttons);
    QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
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
