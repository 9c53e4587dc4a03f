/// Keys: presets, the user's own, and who tells about them.

#include <set>

#include <QAbstractSpinBox>
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenuBar>
#include <QPushButton>
#include <QSettings>
#include <QTabWidget>
#include <QToolButton>
#include <QTreeWidget>

#include "tests/gui/drag_under_test.h"
#include "ui/main_window/shortcuts.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

const Command& command_of(CommandId id) {
    for (const Command& command : commands())
        if (command.id == id) return command;
    qFatal("There is no such command.");
}

/// A window with the page of the keys.
struct KeysUnderTest : DragUnderTest {
    KeysUnderTest() {
        window->action(CommandId::preferences)->trigger();
        auto* pages = find<QTabWidget>("preferences_pages");
        pages->setCurrentIndex(pages->count() - 1);
    }
    QTreeWidget* table() { return find<QTreeWidget>("shortcut_table"); }
    void choose(CommandId id) {
        for (int row = 0; row < table()->topLevelItemCount(); ++row)
            if (table()->topLevelItem(row)->data(0, Qt::UserRole).toInt() == static_cast<int>(id))
                table()->setCurrentItem(table()->topLevelItem(row));
    }
    void press(int key, Qt::KeyboardModifiers modifiers = {}) {
        auto* field = find<QKeySequenceEdit>("shortcut_key");
        field->setFocus();
        QTest::keyClick(field, static_cast<Qt::Key>(key), modifiers);
    }
    QKeySequence key(CommandId id) { return window->action(id)->shortcut(); }
};

}  // namespace

class ShortcutsTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void no_key_is_two_commands_in_any_preset() {
        const WindowUnderTest test;
        std::set<QKeySequence> menus;
        for (const QAction* menu : test.window->menuBar()->actions())
            menus.insert(QKeySequence::mnemonic(menu->text()));
        for (const ShortcutPreset& preset : shortcut_presets()) {
            Shortcuts shortcuts;
            shortcuts.set_preset(QLatin1String(preset.name));
            std::map<QKeySequence, std::string> owners;
            for (const FixedKeys& fixed : fixed_keys())
                if (!fixed.is_in_hand_only && !fixed.command)
                    for (const QKeySequence& key : parse_keys(QLatin1String(fixed.keys))) owners[key] = fixed.text;
            for (const Command& command : commands()) {
                const std::string where = std::string(preset.name) + ": " + command.name;
                for (const QKeySequence& key : shortcuts.keys(command.id)) {
                    const auto [place, is_new] = owners.emplace(key, command.name);
                    QVERIFY2(is_new, (where + " and " + place->second + ": " + key.toString().toStdString()).c_str());
                    QVERIFY2(!menus.contains(key), (where + " opens a menu: " + key.toString().toStdString()).c_str());
                }
                // Nobody is left without a key by a preset.
                QVERIFY2(!*command.shortcuts || !shortcuts.keys(command.id).isEmpty(), where.c_str());
            }
            // What the preset says is what comes out.
            for (const PresetKeys& entry : preset.keys)
                QCOMPARE(shortcuts.keys(entry.command), parse_keys(QLatin1String(entry.keys)));
        }
    }

    void presets_are_understood() {
        for (const ShortcutPreset& preset : shortcut_presets())
            for (const PresetKeys& entry : preset.keys)
                QCOMPARE(parse_keys(QLatin1String(entry.keys)).size(),
                         QString::fromLatin1(entry.keys).count(QLatin1String("; ")) + 1);
        for (const FixedKeys& fixed : fixed_keys()) QVERIFY(!parse_keys(QLatin1String(fixed.keys)).isEmpty());
    }

    void a_preset_counts_at_once_and_is_remembered() {
        {
            KeysUnderTest test;
            auto* preset = test.find<QComboBox>("shortcut_preset");
            preset->setCurrentIndex(preset->findData(QStringLiteral("blender")));
            QCOMPARE(test.key(CommandId::tool_transform), QKeySequence(Qt::Key_G));
            QVERIFY(test.window->action(CommandId::tool_transform)->toolTip().contains(QStringLiteral("G")));
            test.find<QDialog>("preferences_dialog")->close();
            QTest::keyClick(&test.view(), Qt::Key_G);
            QVERIFY(test.window->action(CommandId::tool_transform)->isChecked());
            QTest::keyClick(&test.view(), Qt::Key_A);
            QCOMPARE(static_cast<Index>(test.window->edit().elements().size()), test.topology().element_count());
            QTest::keyClick(&test.view(), Qt::Key_A, Qt::AltModifier);
            QVERIFY(test.window->edit().elements().empty());
            // The number pad's keys are not the row's.
            QTest::keyClick(&test.view(), Qt::Key_N);
            QVERIFY(!test.window->action(CommandId::nodes)->isChecked());
            QVERIFY(!test.window->action(CommandId::panel_operations)->isChecked());
        }
        const WindowUnderTest again;
        QCOMPARE(again.window->action(CommandId::tool_transform)->shortcut(), QKeySequence(Qt::Key_G));
    }

    void while_something_is_in_hand_no_key_is_a_command() {
        for (const ShortcutPreset& preset : shortcut_presets()) {
            DragUnderTest test;
            Shortcuts shortcuts;
            test.window->findChild<Shortcuts*>()->set_preset(QLatin1String(preset.name));
            test.take(test.node_at(0.5, 0.0));
            std::map<CommandId, bool> checked;
            int triggered = 0;
            for (const Command& command : commands()) {
                checked[command.id] = test.window->action(command.id)->isChecked();
                QObject::connect(test.window->action(command.id), &QAction::triggered, &test.view(),
                                 [&triggered] { ++triggered; });
            }
            for (const Qt::Key key : {Qt::Key_X, Qt::Key_Y, Qt::Key_Z, Qt::Key_N, Qt::Key_G, Qt::Key_S, Qt::Key_M})
                QTest::keyClick(&test.view(), key);
            QCOMPARE(triggered, 0);
            QTest::keyClick(&test.view(), Qt::Key_Escape);
            QVERIFY(!test.drag().is_active());
        }
    }

    void own_keys_are_given_refused_and_taken() {
        {
            KeysUnderTest test;
            auto* take = test.find<QPushButton>("shortcut_take");
            auto* reset = test.find<QPushButton>("shortcut_reset");
            test.choose(CommandId::flip);
            QCOMPARE(test.text("shortcut_command"), QStringLiteral("Flip numbering"));
            QVERIFY(!reset->isEnabled());
            test.press(Qt::Key_J, Qt::ControlModifier);
            QCOMPARE(test.key(CommandId::flip), QKeySequence(QStringLiteral("Ctrl+J")));
            QVERIFY(test.text("shortcut_message").isEmpty());
            QVERIFY(reset->isEnabled());

            // Somebody else's: refused by a sentence that says whose, then taken.
            test.press(Qt::Key_W, Qt::ControlModifier);
            QCOMPARE(test.text("shortcut_message"), QStringLiteral("Ctrl+W is the key of “Close mesh”."));
            QVERIFY(take->isVisible());
            QCOMPARE(test.key(CommandId::flip), QKeySequence(QStringLiteral("Ctrl+J")));
            QCOMPARE(test.key(CommandId::close_mesh), QKeySequence(QStringLiteral("Ctrl+W")));
            test.click("shortcut_take");
            QCOMPARE(test.key(CommandId::flip), QKeySequence(QStringLiteral("Ctrl+W")));
            QVERIFY(test.key(CommandId::close_mesh).isEmpty());
            QVERIFY(!take->isVisible());

            // Nobody's to give.
            test.press(Qt::Key_Up);
            QVERIFY(test.text("shortcut_message").startsWith(QStringLiteral("Up cannot be given away")));
            QVERIFY(!take->isVisible());
            test.press(Qt::Key_F, Qt::AltModifier);
            QVERIFY2(test.text("shortcut_message").contains(QStringLiteral("menu File")),
                     qPrintable(test.text("shortcut_message")));
            QCOMPARE(test.key(CommandId::flip), QKeySequence(QStringLiteral("Ctrl+W")));

            test.choose(CommandId::untangle);
            test.click("shortcut_none");
            QVERIFY(test.key(CommandId::untangle).isEmpty());
            QVERIFY(!test.window->action(CommandId::untangle)->toolTip().contains(QStringLiteral("Ctrl+U")));
        }
        {
            KeysUnderTest again;
            QCOMPARE(again.key(CommandId::flip), QKeySequence(QStringLiteral("Ctrl+W")));
            QVERIFY(again.key(CommandId::untangle).isEmpty());
            again.choose(CommandId::untangle);
            again.click("shortcut_reset");
            QCOMPARE(again.key(CommandId::untangle), QKeySequence(QStringLiteral("Ctrl+U")));
            again.click("shortcut_reset_all");
            QCOMPARE(again.key(CommandId::close_mesh), QKeySequence(QStringLiteral("Ctrl+W")));
            QVERIFY(again.key(CommandId::flip).isEmpty());
        }
        const WindowUnderTest last;
        QCOMPARE(last.window->action(CommandId::close_mesh)->shortcut(), QKeySequence(QStringLiteral("Ctrl+W")));
    }

    void the_table_is_searched_by_name_help_and_key() {
        KeysUnderTest test;
        auto* words = test.find<QLineEdit>("shortcut_words");
        QCOMPARE(test.table()->topLevelItemCount(), static_cast<int>(commands().size()));
        for (const char* text : {"untangle", "interior nodes until", "Ctrl+U"}) {
            words->setText(QLatin1String(text));
            bool is_there = false;
            for (int row = 0; row < test.table()->topLevelItemCount(); ++row)
                is_there = is_there || test.table()->topLevelItem(row)->text(0) == QLatin1String("Untangle");
            QVERIFY2(is_there, text);
            QVERIFY(test.table()->topLevelItemCount() < 6);
        }
        QTest::keyClick(words, Qt::Key_Return);
        QVERIFY(words->isVisible());
        words->setText(QStringLiteral("no such thing"));
        QCOMPARE(test.table()->topLevelItemCount(), 0);
        QVERIFY(!test.find<QKeySequenceEdit>("shortcut_key")->isEnabled());
    }

    void the_page_of_help_shows_the_keys_as_they_are() {
        WindowUnderTest test;
        auto* shortcuts = test.window->findChild<Shortcuts*>();
        shortcuts->set_preset(QStringLiteral("glvis"));
        shortcuts->set_own(CommandId::about, QKeySequence(QStringLiteral("Ctrl+F11")));
        test.window->action(CommandId::shortcuts)->trigger();
        test.window->action(CommandId::shortcuts)->trigger();
        int pages = 0;
        for (const QDialog* dialog : test.window->findChildren<QDialog*>()) pages += dialog->isVisible();
        QCOMPARE(pages, 1);
        const auto* page = test.find<QDialog>("shortcuts_dialog");
        QStringList texts;
        for (const QLabel* label : page->findChildren<QLabel*>()) texts << label->text();
        for (const Command& command : commands())
            if (!shortcuts->keys(command.id).isEmpty()) {
                QVERIFY2(texts.contains(keys_text(shortcuts->keys(command.id))), command.name);
                QVERIFY2(texts.contains(help_text(command)), command.name);
            }
        for (const FixedKeys& fixed : fixed_keys()) QVERIFY(texts.contains(fixed_text(fixed)));
        QVERIFY(texts.contains(QStringLiteral("Ctrl+F11")));
        test.click("change_shortcuts");
        QVERIFY(test.find<QDialog>("preferences_dialog")->isVisible());
    }

    void the_palette_shows_the_keys_as_they_are() {
        WindowUnderTest test;
        test.window->findChild<Shortcuts*>()->set_preset(QStringLiteral("blender"));
        test.window->action(CommandId::palette)->trigger();
        auto* list = test.find<QListWidget>("palette_list");
        QTest::keyClicks(test.find<QLineEdit>("palette_words"), QStringLiteral("preferences"));
        QVERIFY(list->item(0)->text().contains(QStringLiteral("Ctrl+,")));
        // What no command answers to is said, and cannot be run.
        QTest::keyClicks(test.find<QLineEdit>("palette_words"), QStringLiteral(" of a teapot"));
        QCOMPARE(list->count(), 1);
        QVERIFY(!(list->item(0)->flags() & Qt::ItemIsEnabled) && !list->currentItem());
        QTest::keyClick(test.find<QLineEdit>("palette_words"), Qt::Key_Return);
        QVERIFY(list->isVisible());
    }

    void broken_settings_are_passed_over() {
        QSettings settings;
        settings.setValue(QStringLiteral("shortcuts/preset"), QStringLiteral("emacs"));
        settings.setValue(QStringLiteral("shortcuts/own/undo"), QStringLiteral("Hyper+Q; ###"));
        settings.setValue(QStringLiteral("shortcuts/own/redo"), QStringLiteral("Ctrl+Alt+9"));
        settings.setValue(QStringLiteral("shortcuts/own/fit"), QStringLiteral("Ctrl+Alt+9"));
        settings.setValue(QStringLiteral("shortcuts/own/nodes"), QStringLiteral("Up"));
        settings.setValue(QStringLiteral("shortcuts/own/nothing"), QStringLiteral("Ctrl+8"));
        const Shortcuts shortcuts;
        QCOMPARE(QLatin1String(shortcuts.preset().name), QLatin1String("curvewright"));
        QCOMPARE(shortcuts.keys(CommandId::undo), parse_keys(QStringLiteral("Ctrl+Z")));
        QCOMPARE(shortcuts.keys(CommandId::redo), parse_keys(QStringLiteral("Ctrl+Alt+9")));
        QVERIFY(shortcuts.keys(CommandId::fit).isEmpty());
        QVERIFY(shortcuts.keys(CommandId::nodes).isEmpty());
    }

    void tips_teach_what_when_and_which_key() {
        const WindowUnderTest test;
        for (const Command& command : commands()) {
            const QString tip = test.window->action(command.id)->toolTip();
            QVERIFY2(tip.contains(help_text(command).toHtmlEscaped()), command.name);
            const QKeySequence key = test.window->action(command.id)->shortcut();
            QVERIFY2(key.isEmpty() || tip.contains(key.toString(QKeySequence::NativeText).toHtmlEscaped()),
                     command.name);
            QVERIFY2(tip.contains(plain_text(command).toHtmlEscaped()), command.name);
            // Of those with a button somebody asks when they are wanted.
            if (command.tool_group > 0) QVERIFY2(lesson_text(command).endsWith(QLatin1Char('.')), command.name);
        }
        QCOMPARE(lesson_text(command_of(CommandId::about)), QString());
    }

    void every_field_of_the_panels_says_what_it_is_for() {
        DragUnderTest test("cube.msh");
        auto* tabs = test.find<QTabWidget>("operations_tabs");
        QStringList silent;
        for (QWidget* field : tabs->findChildren<QWidget*>()) {
            const bool is_field = qobject_cast<QComboBox*>(field) || qobject_cast<QAbstractSpinBox*>(field) ||
                                  qobject_cast<QCheckBox*>(field) || qobject_cast<QToolButton*>(field);
            if (is_field && !field->objectName().isEmpty() && field->toolTip().isEmpty()) silent << field->objectName();
        }
        silent.removeAll(QStringLiteral("ScrollLeftButton"));
        silent.removeAll(QStringLiteral("ScrollRightButton"));
        QVERIFY2(silent.isEmpty(), qPrintable(silent.join(QLatin1Char(' '))));
    }
};

QObject* make_test() {
    return new ShortcutsTest;
}

#include "shortcuts_test.moc"
