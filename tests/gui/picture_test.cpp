/// Pictures of the view: sizes, see-through grounds, the clipboard, and that the view stays as it is.

#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QGuiApplication>
#include <QImage>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QSpinBox>

#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/picture_dialog.h"
#include "ui/main_window/tiled_picture.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

struct PictureUnderTest : WindowUnderTest {
    explicit PictureUnderTest(const char* mesh = "square.msh") {
        open(inputs.path(QLatin1String(mesh)));
        QTest::qWait(50);  // a first frame
    }
    MeshView& view() { return window->view(); }
    PictureDialog* show_dialog() {
        click("tool_save_picture");
        auto* dialog = window->findChild<PictureDialog*>();
        if (!dialog || !QTest::qWaitForWindowExposed(dialog)) qFatal("There is no dialog.");
        return dialog;
    }
    void choose_size(int width, int height) {
        find<QCheckBox>("size_keeps")->setChecked(false);
        type(find<QSpinBox>("size_width"), width);
        type(find<QSpinBox>("size_height"), height);
    }
    static void type(QSpinBox* box, int number) {
        box->selectAll();
        QTest::keyClicks(box, QString::number(number));
        QTest::keyClick(box, Qt::Key_Tab);
    }
    QImage save(const char* name) {
        file_answer = inputs.path(QLatin1String(name));
        click("picture_save");
        if (!QTest::qWaitFor([this] { return !window->findChild<PictureDialog*>(); }, 20000))
            qFatal("The dialog stays: %s", qPrintable(errors.join(QLatin1Char('\n'))));
        return QImage(file_answer);
    }
};

/// Share of the pixels whose alpha is as told.
double share(const QImage& image, const std::function<bool(int alpha)>& is_counted) {
    long long count = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) count += is_counted(qAlpha(image.pixel(x, y)));
    return double(count) / (double(image.width()) * image.height());
}

int largest_difference(const QImage& a, const QImage& b) {
    int largest = a.size() == b.size() ? 0 : 255;
    for (int y = 0; largest < 255 && y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QColor p = a.pixelColor(x, y), q = b.pixelColor(x, y);
            largest = std::max(
                {largest, std::abs(p.red() - q.red()), std::abs(p.green() - q.green()), std::abs(p.blue() - q.blue())});
        }
    return largest;
}

int count_different(const QImage& a, const QImage& b) {
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QColor p = a.pixelColor(x, y), q = b.pixelColor(x, y);
            count += std::abs(p.red() - q.red()) + std::abs(p.green() - q.green()) + std::abs(p.blue() - q.blue()) > 9;
        }
    return count;
}

/// Laid on a ground of one colour.
QImage laid_on(const QImage& image, const QColor& ground) {
    QImage result(image.size(), QImage::Format_RGB888);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const QColor its = image.pixelColor(x, y);
            const double a = its.alphaF();
            result.setPixelColor(x, y,
                                 QColor::fromRgbF(float(a * its.redF() + (1 - a) * ground.redF()),
                                                  float(a * its.greenF() + (1 - a) * ground.greenF()),
                                                  float(a * its.blueF() + (1 - a) * ground.blueF())));
        }
    return result;
}

}  // namespace

class PictureTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void sizes_that_are_asked_for() {
        PictureUnderTest test;
        const QSize view = test.view().device_size();
        test.show_dialog();
        QCOMPARE(test.find<QSpinBox>("size_width")->value(), view.width());
        QCOMPARE(test.save("once.png").size(), view);
        test.show_dialog();
        test.find<QComboBox>("size_preset")->setCurrentIndex(1);
        test.save("twice");  // gets its suffix
        QVERIFY(!QFile::exists(test.inputs.path(QStringLiteral("twice"))));
        QCOMPARE(QImage(test.inputs.path(QStringLiteral("twice.png"))).size(), 2 * view);
        test.show_dialog();
        test.find<QComboBox>("size_preset")->setCurrentIndex(2);
        QCOMPARE(test.save("hd.png").size(), QSize(1920, 1080));
        test.show_dialog();
        // What was chosen last is there again; the sides keep their proportion where that is wanted.
        QCOMPARE(test.find<QComboBox>("size_preset")->currentIndex(), 2);
        PictureUnderTest::type(test.find<QSpinBox>("size_width"), 960);
        QCOMPARE(test.find<QSpinBox>("size_height")->value(), 540);
        QCOMPARE(test.find<QComboBox>("size_preset")->currentIndex(), 4);
        test.choose_size(333, 777);
        const QImage odd = test.save("odd.png");
        QCOMPARE(odd.size(), QSize(333, 777));
        // All of the mesh is in it: the ground is at both sides, the mesh in the middle.
        const QRgb ground = odd.pixel(1, 1);
        for (int y = 0; y < odd.height(); ++y) {
            QCOMPARE(odd.pixel(0, y), ground);
            if (y < 250 || y > 600) QCOMPARE(odd.pixel(20, y), ground);
        }
        QVERIFY(odd.pixel(110, odd.height() / 2) != ground);
        QVERIFY(test.errors.isEmpty());
    }

    void a_picture_as_large_as_the_view_is_the_view() {
        PictureUnderTest test;
        // Zoomed and moved: what is seen is what is drawn.
        QTest::mousePress(&test.view(), Qt::MiddleButton, {}, {300, 200});
        QTest::mouseMove(&test.view(), {340, 260});
        QTest::mouseRelease(&test.view(), Qt::MiddleButton, {}, {340, 260});
        const QImage before = test.view().grabFramebuffer();
        test.show_dialog();
        const QImage picture = test.save("view.png");
        // Borders are smoother in the picture; all else is the same.
        int differing = 0;
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x) {
                const QColor p = picture.pixelColor(x, y), q = before.pixelColor(x, y);
                differing += std::abs(p.red() - q.red()) + std::abs(p.blue() - q.blue()) > 60;
            }
        QVERIFY2(differing < picture.width() * picture.height() / 50, qPrintable(QString::number(differing)));
        QCOMPARE(largest_difference(test.view().grabFramebuffer(), before), 0);
        // A view that was fitted is still fitted when the window changes its size.
        test.window->action(CommandId::fit)->trigger();
        QTest::qWait(30);
        const double unit = test.view().units_per_pixel({0.0, 0.0, 0.0});
        test.show_dialog();
        test.choose_size(400, 900);
        test.save("high.png");
        QTest::qWait(30);
        QCOMPARE(test.view().units_per_pixel({0.0, 0.0, 0.0}), unit);
        test.window->resize(1000, 700);
        QTest::qWait(60);
        QVERIFY(test.view().units_per_pixel({0.0, 0.0, 0.0}) != unit);
    }

    void a_see_through_picture_has_no_ground_in_it_data() {
        QTest::addColumn<QString>("mesh");
        QTest::newRow("flat") << QStringLiteral("square.msh");
        QTest::newRow("solid") << QStringLiteral("cube.msh");
    }
    void a_see_through_picture_has_no_ground_in_it() {
        QFETCH(QString, mesh);
        PictureUnderTest test(mesh.toLatin1().constData());
        const PictureOptions opaque{.size = {600, 400}};
        PictureOptions clear = opaque;
        clear.is_transparent = true;
        const QImage on_ground = test.view().picture(opaque), without = test.view().picture(clear);
        QVERIFY(!on_ground.hasAlphaChannel() && without.hasAlphaChannel());
        QCOMPARE(qAlpha(without.pixel(1, 1)), 0);
        QCOMPARE(qAlpha(without.pixel(240, 200)), 255);
        QVERIFY(share(without, [](int alpha) { return alpha == 0; }) > 0.3);
        QVERIFY(share(without, [](int alpha) { return alpha == 255; }) > 0.15);
        QVERIFY(share(without, [](int alpha) { return alpha > 0 && alpha < 255; }) > 0.001);
        const QColor ground = on_ground.pixelColor(1, 1);
        QVERIFY(largest_difference(laid_on(without, ground), on_ground) <= 2);

        // Written as it is. The legend is left out on request; then the ground under it is clear as well.
        test.show_dialog();
        test.find<QCheckBox>("picture_transparent")->setChecked(true);
        test.find<QCheckBox>("picture_legend")->setChecked(false);
        test.choose_size(600, 400);
        const QImage written = test.save("clear.png");
        QVERIFY(written.hasAlphaChannel());
        QVERIFY(share(written.copy(480, 0, 120, 400), [](int alpha) { return alpha > 0; }) <
                share(without.copy(480, 0, 120, 400), [](int alpha) { return alpha > 0; }));
        test.show_dialog();
        QVERIFY(test.find<QCheckBox>("picture_transparent")->isChecked());
        QVERIFY(!test.find<QCheckBox>("picture_legend")->isChecked());
    }

    void lines_grow_with_the_picture_and_by_choice() {
        PictureUnderTest test;
        // What the edges take from the light of the picture, per pixel.
        const auto ink = [&test](const PictureOptions& options) {
            double sum = 0.0;
            for (const double sign : {-1.0, 1.0}) {
                SceneOptions shown = test.view().options();
                shown.show_edges = sign < 0.0;
                test.view().set_options(shown);
                const QImage image = test.view().picture(options);
                for (int y = 0; y < image.height(); ++y)
                    for (int x = 0; x < image.width(); ++x) sum += sign * qGray(image.pixel(x, y));
            }
            return sum / (double(options.size.width()) * options.size.height());
        };
        PictureOptions options{.size = test.view().device_size(), .has_legend = false};
        const double once = ink(options);
        QVERIFY(once > 0.5);
        options.size *= 2;
        const double twice = ink(options);
        QVERIFY2(std::abs(twice / once - 1.0) < 0.1, qPrintable(QString::number(twice / once)));
        options.line_scale = 3.0;
        const double thick = ink(options);
        QVERIFY2(std::abs(thick / twice - 3.0) < 0.5, qPrintable(QString::number(thick / twice)));
    }

    void tiles_make_the_same_picture_data() {
        QTest::addColumn<QString>("mesh");
        QTest::addColumn<bool>("is_transparent");
        QTest::newRow("flat") << QStringLiteral("square.msh") << false;
        QTest::newRow("solid") << QStringLiteral("cube.msh") << false;
        QTest::newRow("see-through") << QStringLiteral("cube.msh") << true;
    }
    void tiles_make_the_same_picture() {
        QFETCH(QString, mesh);
        QFETCH(bool, is_transparent);
        PictureUnderTest test(mesh.toLatin1().constData());
        // Sides that tiles divide evenly, and one that they do not.
        for (const QSize size : {QSize(600, 400), QSize(601, 397)}) {
            PictureOptions options{.size = size};
            options.is_transparent = is_transparent;
            const long long before = std::exchange(TiledPicture::tile_pixels, 100'000);
            const long long points = std::exchange(MeshScene::most_points_of_part, 1);
            TiledPicture tiled(test.view(), options);
            QSignalSpy finished(&tiled, &TiledPicture::finished), progress(&tiled, &TiledPicture::progress);
            QVERIFY(finished.wait(20000));
            TiledPicture::tile_pixels = before;
            MeshScene::most_points_of_part = points;
            QVERIFY2(progress.count() >= 9, qPrintable(QString::number(progress.count())));
            QImage image = finished[0][0].value<QImage>(), whole = test.view().picture(options);
            QCOMPARE(image.size(), size);
            QCOMPARE(image.hasAlphaChannel(), is_transparent);
            QCOMPARE(whole.hasAlphaChannel(), is_transparent);
            if (is_transparent) {
                // What is hardly there has hardly a colour.
                image = laid_on(image, Qt::white);
                whole = laid_on(whole, Qt::white);
            }
            // Where tiles reach beyond the picture it is drawn a pixel or two larger, and cut.
            const bool is_even = size.width() == 600;
            const int largest = largest_difference(image, whole), count = count_different(image, whole);
            QVERIFY2(!is_even || largest <= 3, qPrintable(QString::number(largest)));
            QVERIFY2(count < size.width() * size.height() / (is_even ? 1000 : 8), qPrintable(QString::number(count)));
        }
    }

    void the_window_lives_on_while_a_picture_is_drawn_and_can_stop_it() {
        PictureUnderTest test;
        PictureDialog* dialog = test.show_dialog();
        test.choose_size(3840, 2160);
        auto* progress = test.find<QProgressBar>("picture_progress");
        QVERIFY(!progress->isVisible());
        for (const bool by_key : {false, true}) {
            test.file_answer = test.inputs.path(QStringLiteral("stopped.png"));
            test.click("picture_save");
            QVERIFY(progress->isVisible());
            QVERIFY(!test.find<QPushButton>("picture_save")->isEnabled());
            QTRY_VERIFY(progress->value() > 0);
            QVERIFY(dialog->is_busy());
            if (by_key)
                QTest::keyClick(dialog, Qt::Key_Escape);
            else
                test.click("picture_stop");
            QVERIFY(!dialog->is_busy());
            QVERIFY(!progress->isVisible());
            QVERIFY(dialog->isVisible());
            QTest::qWait(100);
            QVERIFY(!QFile::exists(test.file_answer));
            QVERIFY(test.find<QPushButton>("picture_save")->isEnabled());
        }
        // What the view showed when it was begun is what is in it.
        test.choose_size(800, 500);
        PictureOptions options{.size = {800, 500}};
        const QImage before = test.view().picture(options);
        test.file_answer = test.inputs.path(QStringLiteral("begun.png"));
        test.click("picture_save");
        test.window->action(CommandId::edges)->trigger();
        QTRY_VERIFY(!test.window->findChild<PictureDialog*>());
        QVERIFY(largest_difference(QImage(test.file_answer), before) <= 3);
        QVERIFY(largest_difference(test.view().picture(options), before) > 3);
        // Opening another mesh gives it up.
        test.show_dialog();
        test.choose_size(3840, 2160);
        test.file_answer = test.inputs.path(QStringLiteral("given_up.png"));
        test.click("picture_save");
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        QTRY_VERIFY(!test.window->findChild<PictureDialog*>());
        QTest::qWait(100);
        QVERIFY(!QFile::exists(test.file_answer));
        QVERIFY(test.errors.isEmpty());
    }

    void the_clipboard_gets_it_with_its_alpha() {
        PictureUnderTest test;
        test.show_dialog();
        test.find<QCheckBox>("picture_transparent")->setChecked(true);
        test.choose_size(320, 200);
        QGuiApplication::clipboard()->clear();
        test.click("picture_copy");
        QTRY_VERIFY(!QGuiApplication::clipboard()->image().isNull());
        const QImage copied = QGuiApplication::clipboard()->image();
        QCOMPARE(copied.size(), QSize(320, 200));
        QCOMPARE(qAlpha(copied.pixel(1, 1)), 0);
        QCOMPARE(qAlpha(copied.pixel(120, 100)), 255);
    }

    void the_preview_follows_choices_and_view() {
        PictureUnderTest test;
        PictureDialog* dialog = test.show_dialog();
        auto* preview = test.find<PreviewLabel>("picture_preview");
        QVERIFY(dialog->is_drawing_preview());
        QTRY_VERIFY(!dialog->is_drawing_preview());
        QVERIFY(!preview->picture().isNull());
        QVERIFY(!preview->picture().hasAlphaChannel());
        test.find<QCheckBox>("picture_transparent")->setChecked(true);
        QTRY_VERIFY(preview->picture().hasAlphaChannel());
        test.choose_size(300, 900);
        QTRY_VERIFY(preview->picture().height() > 2 * preview->picture().width());
        const QImage before = preview->picture();
        test.window->action(CommandId::edges)->trigger();
        QTest::mousePress(&test.view(), Qt::MiddleButton, {}, {300, 200});
        QTest::mouseMove(&test.view(), {340, 260});
        QTest::mouseRelease(&test.view(), Qt::MiddleButton, {}, {340, 260});
        QTRY_VERIFY(preview->picture() != before);
        dialog->reject();
    }

    void too_large_and_unwritable_are_told() {
        PictureUnderTest test;
        PictureDialog* dialog = test.show_dialog();
        test.choose_size(99999, 20);
        auto* message = test.find<QLabel>("picture_message");
        QVERIFY(message->isVisible());
        QVERIFY2(message->text().startsWith(QStringLiteral("A picture of 99,999 × 20 pixels cannot be drawn here")),
                 qPrintable(message->text()));
        QVERIFY(!test.find<QPushButton>("picture_save")->isEnabled());
        QVERIFY(!test.find<QPushButton>("picture_copy")->isEnabled());
        test.choose_size(15000, 15000);
        QVERIFY(message->text().contains(QStringLiteral("100 million in all")));
        test.choose_size(200, 200);
        QVERIFY(!message->isVisible());
        test.file_answer = QStringLiteral("/nonexistent-folder/picture.png");
        test.click("picture_save");
        QTRY_COMPARE(test.errors.size(), 1);
        QVERIFY(test.errors[0].contains(QStringLiteral("/nonexistent-folder/picture.png")));
        QTRY_VERIFY(test.find<QPushButton>("picture_save")->isEnabled());
        QVERIFY(dialog->isVisible());
        dialog->reject();
    }
};

QObject* make_test() {
    return new PictureTest;
}

#include "picture_test.moc"
