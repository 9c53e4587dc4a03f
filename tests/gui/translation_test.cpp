/// Ready for translation: with a translator that brackets everything, no visible text is without brackets.

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QAction>
#include <QComboBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QFile>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QRegularExpression>
#include <QSettings>
#include <QSpinBox>
#include <QStatusBar>
#include <QTabBar>
#include <QTabWidget>
#include <QTranslator>
#include <QTreeWidget>
#include <QUndoView>

#include "app/desktop/translations.h"
#include "tests/gui/drag_under_test.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

class BracketTranslator : public QTranslator {
  public:
    bool isEmpty() const override { return false; }
    QString translate(const char*, const char* source, const char*, int) const override {
        return QChar(0x27e6) + QString::fromUtf8(source) + QChar(0x27e7);
    }
};

/// What people may read untranslated: names that are data, and the program's own.
QStringList data_of(const MainWindow& window) {
    QStringList data{QStringLiteral("Curvewright"), QDir::homePath(), QDir::tempPath()};
    for (const Sample& sample : window.samples().samples())
        data << sample.title << sample.description << sample.look_for << sample.name;
    data << window.samples().error();
    // A title may begin another one.
    std::sort(data.begin(), data.end(), [](const QString& a, const QString& b) { return a.size() > b.size(); });
    return data;
}

/// What is left of a text without markup, brackets, files and data.
QString untranslated(QString text, const QStringList& data) {
    static const QRegularExpression markup(QStringLiteral("<[^<>]*>|&[a-z]+;"));
    static const QRegularExpression brackets(QStringLiteral("\\x{27e6}[^\\x{27e6}\\x{27e7}]*\\x{27e7}"));
    static const QRegularExpression files(QStringLiteral("\\S*(/|\\.(msh|json|csv|vtu|gz))\\S*"));
    static const QRegularExpression groups(QStringLiteral("\\b(bottom|right|top|left|domain|all_boundary|sin|pi)\\b"));
    static const QRegularExpression words(QStringLiteral("\\p{L}{2,}"));
    text.replace(markup, QStringLiteral(" "));
    for (qsizetype length = -1; length != text.size();) {
        length = text.size();
        text.replace(brackets, QStringLiteral(" "));
    }
    for (const QString& known : data)
        if (!known.isEmpty()) text.remove(known);
    text.remove(files).remove(groups);
    return words.match(text).hasMatch() ? text : QString();
}

/// All that a widget shows, with what tells where it is.
QStringList texts_of(QWidget* widget) {
    QStringList texts{widget->toolTip(), widget->statusTip(), widget->accessibleName()};
    if (widget->isWindow()) texts << widget->windowTitle();
    if (const auto* label = qobject_cast<QLabel*>(widget)) texts << label->text();
    if (const auto* button = qobject_cast<QAbstractButton*>(widget)) texts << button->text();
    if (const auto* line = qobject_cast<QLineEdit*>(widget)) texts << line->placeholderText();
    if (const auto* box = qobject_cast<QSpinBox*>(widget)) texts << box->prefix() << box->suffix();
    if (const auto* box = qobject_cast<QDoubleSpinBox*>(widget)) texts << box->prefix() << box->suffix();
    if (const auto* box = qobject_cast<QAbstractSpinBox*>(widget)) texts << box->specialValueText();
    if (const auto* bar = qobject_cast<QStatusBar*>(widget)) texts << bar->currentMessage();
    if (const auto* box = qobject_cast<QComboBox*>(widget))
        for (int i = 0; i < box->count(); ++i)
            texts << box->itemText(i) << box->itemData(i, Qt::ToolTipRole).toString();
    if (const auto* bar = qobject_cast<QTabBar*>(widget))
        for (int i = 0; i < bar->count(); ++i) texts << bar->tabText(i) << bar->tabToolTip(i);
    if (const auto* view = qobject_cast<QAbstractItemView*>(widget); view && view->model()) {
        const QAbstractItemModel* model = view->model();
        for (int column = 0; column < model->columnCount(); ++column) {
            texts << (qobject_cast<const QTreeView*>(view) ? model->headerData(column, Qt::Horizontal).toString()
                                                           : QString());
            for (int row = 0; row < model->rowCount(); ++row) {
                const QModelIndex index = model->index(row, column);
                texts << index.data().toString() << index.data(Qt::ToolTipRole).toString();
            }
        }
    }
    for (const QAction* action : widget->actions()) texts << action->text() << action->toolTip() << action->statusTip();
    return texts;
}

}  // namespace

class TranslationTest : public QObject {
    Q_OBJECT

    BracketTranslator translator_;
    QStringList found_;  ///< of all states looked at
    int seen_ = 0;

    /// Looks at everything that is there now.
    void look(const MainWindow& window, const char* where) {
        const QStringList data = data_of(window);
        QWidgetList all = QApplication::allWidgets();
        for (QWidget* widget : all) {
            // Columns that are only numbers of an empty header, and Qt's own parts that are never seen.
            if (qobject_cast<QHeaderView*>(widget)) continue;
            if (widget->objectName().startsWith(QLatin1String("qt_")) && !widget->isVisible()) continue;
            for (const QString& text : texts_of(widget)) {
                if (text.isEmpty()) continue;
                ++seen_;
                const QString rest = untranslated(text, data);
                if (rest.isEmpty()) continue;
                const QString line = QStringLiteral("%1: %2 %3: %4")
                                         .arg(QLatin1String(where), QLatin1String(widget->metaObject()->className()),
                                              widget->objectName(), text);
                if (!found_.contains(line)) found_ << line;
            }
        }
    }
    void verdict() {
        for (const QString& line : found_) qWarning("untranslated: %s", qPrintable(line));
        QVERIFY(found_.isEmpty());
        QVERIFY(seen_ > 100);
    }

  private slots:
    void init() {
        QSettings().clear();
        found_.clear();
        seen_ = 0;
        QCoreApplication::installTranslator(&translator_);
    }
    void cleanup() { QCoreApplication::removeTranslator(&translator_); }

    void the_check_finds_what_is_not_translated() {
        QVERIFY(!untranslated(QStringLiteral("Save"), {}).isEmpty());
        QVERIFY(!untranslated(QStringLiteral("⟦Save⟧ it"), {}).isEmpty());
        QVERIFY(untranslated(QStringLiteral("<b>⟦min ⟦a⟧⟧</b> 0.5 x, P3 · square.msh"), {}).isEmpty());
        const QLabel label(QStringLiteral("plain"));
        const WindowUnderTest test;
        look(*test.window, "label");
        QCOMPARE(found_.filter(QStringLiteral("plain")).size(), 1);
    }

    void start_page_menus_and_commands() {
        WindowUnderTest test;
        for (QMenu* menu : test.window->findChildren<QMenu*>()) emit menu->aboutToShow();
        look(*test.window, "start page");
        for (const Command& command : commands()) {
            const QString tip = test.window->action(command.id)->toolTip();
            QVERIFY2(untranslated(tip, {}).isEmpty(), qPrintable(tip));
        }
        verdict();
    }

    void a_flat_mesh_every_tab_and_tool() {
        DragUnderTest test;
        test.window->open_file(test.inputs.path(QStringLiteral("bump.json")));
        auto* tabs = test.find<QTabWidget>("operations_tabs");
        for (int i = 0; i < tabs->count(); ++i) {
            tabs->setCurrentIndex(i);
            look(*test.window, "tab");
        }
        for (const CommandId tool : {CommandId::tool_look, CommandId::tool_select, CommandId::tool_transform,
                                     CommandId::tool_pin, CommandId::tool_drag}) {
            test.window->action(tool)->trigger();
            test.point_at(test.place_of(test.node_at(0.5, 0.0)));
            look(*test.window, "tool");
        }
        test.take(test.node_at(0.5, 0.0));
        test.move_by({0, -20});
        look(*test.window, "drag");
        test.let_go();
        test.window->action(CommandId::deform)->trigger();
        QVERIFY(test.wait_for_job());
        look(*test.window, "deformed");
        test.window->action(CommandId::untangle)->trigger();
        QVERIFY(test.wait_for_job());
        test.window->edit().select_nodes({test.node_at(0.0, 0.0)});
        look(*test.window, "node");
        test.window->edit().select_elements({0, 1});
        look(*test.window, "elements");
        test.window->action(CommandId::compare)->trigger();
        look(*test.window, "compare");
        verdict();
    }

    void solids_and_meshes_that_need_words() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        test.window->action(CommandId::clip)->trigger();
        look(*test.window, "solid");
        for (const char* file : {"clockwise.msh", "quad.msh"}) {
            test.open(test.inputs.path(QLatin1String(file)));
            look(*test.window, file);
        }
        verdict();
    }

    void dialogs() {
        DragUnderTest test;
        test.window->action(CommandId::palette)->trigger();
        look(*test.window, "palette");
        test.find<QDialog>("command_palette")->close();
        test.window->action(CommandId::find)->trigger();
        look(*test.window, "find");
        QTest::keyClicks(test.find<QLineEdit>("find_tags"), QStringLiteral("99999 e1"));
        look(*test.window, "found");
        test.find<QDialog>("find_dialog")->close();
        test.window->action(CommandId::shortcuts)->trigger();
        look(*test.window, "keys");
        test.find<QDialog>("shortcuts_dialog")->close();
        test.window->action(CommandId::preferences)->trigger();
        auto* pages = test.find<QTabWidget>("preferences_pages");
        for (int i = 0; i < pages->count(); ++i) {
            pages->setCurrentIndex(i);
            look(*test.window, "preferences");
        }
        test.find<QDialog>("preferences_dialog")->close();
        test.window->action(CommandId::about)->trigger();
        look(*test.window, "about");
        Dialogs::standard().show_error(test.window.get(), QStringLiteral("⟦title⟧"), QStringLiteral("⟦text⟧"));
        look(*test.window, "error");
        for (QMessageBox* box : test.window->findChildren<QMessageBox*>()) box->close();
        verdict();
    }

    void a_translation_is_found_by_the_language() {
        QTemporaryDir folder;
        // A translation of nothing: what makes it one is its first bytes, and a table of no messages.
        static const unsigned char magic[] = {0x3c, 0xb8, 0x64, 0x18, 0xca, 0xef, 0x9c, 0x95,
                                              0xcd, 0x21, 0x1c, 0xbf, 0x60, 0xa1, 0xbd, 0xdd};
        static const unsigned char tables[] = {0x42, 0, 0, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0x69, 0, 0, 0, 1, 0};
        QFile file(folder.filePath(QStringLiteral("curvewright_de.qm")));
        QVERIFY(file.open(QIODevice::WriteOnly));
        file.write(reinterpret_cast<const char*>(magic), sizeof magic);
        file.write(reinterpret_cast<const char*>(tables), sizeof tables);
        file.close();
        QObject owner;
        QCOMPARE(install_translations(QLocale(QStringLiteral("de_AT")), {folder.path()}, &owner),
                 QStringList{file.fileName()});
        QCOMPARE(owner.findChildren<QTranslator*>().size(), 1);
        QVERIFY(install_translations(QLocale(QStringLiteral("fr_FR")), {folder.path()}, &owner).isEmpty());
        // English is the program's own.
        QVERIFY(install_translations(QLocale(QStringLiteral("en_US")), {folder.path()}, &owner).isEmpty());
    }
};

QObject* make_test() {
    return new TranslationTest;
}

#include "translation_test.moc"
