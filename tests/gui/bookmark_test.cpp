/// Bookmarks of views: added, gone to by key, kept for the next start, edited.

#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QSettings>
#include <QSlider>
#include <QToolButton>

#include "tests/gui/gui_test_support.h"
#include "ui/document/view_bookmarks.h"
#include "ui/main_window/bookmark_dialog.h"
#include "ui/main_window/mesh_view.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

bool is_close(const ViewPose& a, const ViewPose& b) {
    double largest = std::abs(a.scale - b.scale);
    for (std::size_t i = 0; i < 3; ++i)
        largest = std::max({largest, std::abs(a.position[i] - b.position[i]), std::abs(a.focus[i] - b.focus[i]),
                            std::abs(a.up[i] - b.up[i])});
    return largest < 1e-12;
}

struct BookmarksUnderTest : WindowUnderTest {
    explicit BookmarksUnderTest(const char* mesh) {
        open(inputs.path(QLatin1String(mesh)));
        QTest::qWait(50);
    }
    MeshView& view() { return window->view(); }
    void move_camera(QPoint way) {
        const QPoint at(300, 200);
        QTest::mousePress(&view(), Qt::RightButton, {}, at);
        QTest::mouseMove(&view(), at + way / 2);
        QTest::mouseMove(&view(), at + way);
        QTest::mouseRelease(&view(), Qt::RightButton, {}, at + way);
        QWheelEvent wheel(QPointF(300, 200), view().mapToGlobal(QPointF(300, 200)), {}, {0, 240}, Qt::NoButton, {},
                          Qt::NoScrollPhase, false);
        QApplication::sendEvent(&view(), &wheel);
        QTest::qWait(30);
    }
    void press_key(int number) {
        QTest::keyClick(window.get(), static_cast<Qt::Key>(Qt::Key_0 + number), Qt::ControlModifier);
    }
};

}  // namespace

class BookmarkTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void views_are_kept_and_gone_back_to_data() {
        QTest::addColumn<QString>("mesh");
        QTest::newRow("flat") << QStringLiteral("square.msh");
        QTest::newRow("solid") << QStringLiteral("cube.msh");
    }
    void views_are_kept_and_gone_back_to() {
        QFETCH(QString, mesh);
        const bool is_solid = mesh == QLatin1String("cube.msh");
        ViewPose first, second;
        BookmarksUnderTest test(mesh.toLatin1().constData());
        const QString path = test.window->document().file_path();
        first = test.view().pose();
        if (is_solid) {
            test.window->action(CommandId::clip)->setChecked(true);
            test.find<QToolButton>("clip_y")->click();
            test.find<QSlider>("clip_position")->setValue(60);
        }
        test.window->action(CommandId::bookmark_add)->trigger();
        QCOMPARE(test.text_suggestion, QStringLiteral("View 1"));
        test.move_camera({60, 40});
        second = test.view().pose();
        QVERIFY(!is_close(first, second));
        test.window->action(CommandId::clip)->setChecked(false);
        test.window->action(CommandId::nodes)->setChecked(true);
        test.text_answer = QStringLiteral("Near & far");
        test.window->action(CommandId::bookmark_add)->trigger();
        QCOMPARE(test.text_suggestion, QStringLiteral("View 2"));
        // Given up: nothing is added.
        test.text_answer = QStringLiteral("");
        test.window->action(CommandId::bookmark_add)->trigger();

        test.press_key(1);
        QTRY_VERIFY(is_close(test.view().pose(), first));
        QCOMPARE(test.window->action(CommandId::clip)->isChecked(), is_solid);
        QVERIFY(!test.window->action(CommandId::nodes)->isChecked());
        if (is_solid) {
            QCOMPARE(test.view().options().clip->normal[1], 1.0);
            QCOMPARE(test.view().options().clip->position, 0.3);
        }
        // Beside the state before: both views go there.
        test.window->action(CommandId::compare)->setChecked(true);
        test.press_key(2);
        QTRY_VERIFY(is_close(test.view().pose(), second));
        QTRY_VERIFY(is_close(test.find<MeshView>("before_view")->pose(), second));
        QVERIFY(test.window->action(CommandId::nodes)->isChecked());
        QVERIFY(!test.window->action(CommandId::clip)->isChecked());
        test.press_key(3);  // there is none
        QTest::qWait(20);
        QVERIFY(is_close(test.view().pose(), second));
        test.window.reset();

        // At the next start they are there, for this mesh alone.
        WindowUnderTest later;
        later.open(path);
        QTest::qWait(50);
        auto* action = later.find<QAction>("bookmark_2");
        QCOMPARE(action->text(), QStringLiteral("Near && far"));
        action->trigger();
        QTRY_VERIFY(is_close(later.window->view().pose(), second));
        QTest::keyClick(later.window.get(), Qt::Key_1, Qt::ControlModifier);
        QTRY_VERIFY(is_close(later.window->view().pose(), first));
        later.open(later.inputs.path(QStringLiteral("quad.msh")));
        QVERIFY(!later.window->findChild<QAction*>(QStringLiteral("bookmark_1")));
        QVERIFY(!later.window->action(CommandId::bookmark_edit)->isEnabled());
    }

    void they_are_renamed_sorted_and_removed() {
        BookmarksUnderTest test("square.msh");
        for (int i = 0; i < 3; ++i) {
            test.window->action(CommandId::bookmark_add)->trigger();
            test.move_camera({20, 10});
        }
        test.window->action(CommandId::bookmark_edit)->trigger();
        auto* list = test.find<QListWidget>("bookmark_list");
        QCOMPARE(list->count(), 3);
        list->setCurrentRow(1);
        QTest::mouseClick(test.find<QPushButton>("bookmark_rename"), Qt::LeftButton);
        auto* editor = list->findChild<QLineEdit*>();
        QVERIFY(editor);
        editor->selectAll();
        QTest::keyClicks(editor, QStringLiteral("The corner"));
        QTest::keyClick(editor, Qt::Key_Return);
        QTRY_COMPARE(test.find<QAction>("bookmark_2")->text(), QStringLiteral("The corner"));
        // No name is no name.
        list->item(1)->setText(QStringLiteral("  "));
        QCOMPARE(list->item(1)->text(), QStringLiteral("The corner"));
        list->setCurrentRow(0);
        QTest::mouseClick(test.find<QPushButton>("bookmark_remove"), Qt::LeftButton);
        QCOMPARE(test.find<QAction>("bookmark_1")->text(), QStringLiteral("The corner"));
        QVERIFY(!test.window->findChild<QAction*>(QStringLiteral("bookmark_3")));
        // Another one is not called like one that is there.
        test.window->action(CommandId::bookmark_add)->trigger();
        QCOMPARE(test.text_suggestion, QStringLiteral("View 1"));
        ViewBookmarks read;
        read.set_mesh(test.window->document().file_path());
        QCOMPARE(read.list().size(), 3);
        QCOMPARE(read.list()[0].name, QStringLiteral("The corner"));
    }

    void settings_stay_small_and_damage_is_passed_over() {
        ViewBookmarks bookmarks;
        ViewBookmark bookmark{QStringLiteral("a"), {{1.0 / 3.0, 2.0, 3.0}, {0.1, 0.2, 0.3}, {0.0, 1.0, 0.0}, 0.7}, {}};
        bookmarks.set_mesh(QStringLiteral("/meshes/a.msh"));
        while (!bookmarks.is_full()) bookmarks.add(bookmark);
        QCOMPARE(bookmarks.list().size(), ViewBookmarks::most_of_a_mesh);
        ViewBookmarks same;
        same.set_mesh(QStringLiteral("/meshes/a.msh"));
        QCOMPARE(same.list().size(), bookmarks.list().size());
        QVERIFY(same.list().back().pose == bookmark.pose);  // bit by bit
        for (int i = 0; i < ViewBookmarks::most_meshes + 5; ++i) {
            bookmarks.set_mesh(QStringLiteral("/meshes/%1.msh").arg(i));
            bookmarks.add(bookmark);
        }
        QSettings settings;
        settings.beginGroup(QStringLiteral("bookmarks"));
        QCOMPARE(settings.childKeys().size(), ViewBookmarks::most_meshes);
        settings.endGroup();
        const char* damaged[] = {"",
                                 "[]",
                                 "{\"views\": 3}",
                                 "{\"views\": [3, {}, {\"name\": \"x\", \"pose\": {}}]}",
                                 "{\"views\": [{\"name\":\"x\",\"pose\":{\"position\":[0,0,0],\"focus\":[0,0,0],"
                                 "\"up\":[0,1,0],\"scale\":1}}]}",
                                 "{\"views\": [{\"name\":\"x\",\"pose\":{\"position\":[0,0,\"z\"]}}]}"};
        for (const char* text : damaged) {
            for (const QString& key : settings.allKeys())
                if (key.startsWith(QStringLiteral("bookmarks/"))) settings.setValue(key, QString::fromLatin1(text));
            bookmarks.set_mesh(QStringLiteral("/meshes/20.msh"));
            QVERIFY(bookmarks.list().isEmpty());
        }
    }
};

QObject* make_test() {
    return new BookmarkTest;
}

#include "bookmark_test.moc"
