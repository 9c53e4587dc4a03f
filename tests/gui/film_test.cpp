/// Animations: how many pictures, the first and the last one, sizes, stopping, and the line for a video.

#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QGuiApplication>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QPainter>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>

#include "core/io/atomic_file.h"
#include "core/session/timeline_frames.h"
#include "tests/gui/gui_test_support.h"
#include "tests/support/decoded_animation.h"
#include "ui/jobs/film.h"
#include "ui/main_window/film_dialog.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/picture_drawing.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

/// A window with a mesh that was deformed and warped.
struct FilmUnderTest : WindowUnderTest {
    QTemporaryDir folder;

    explicit FilmUnderTest(const char* mesh = "square.msh", const char* deformation = "gentle.json") {
        open(inputs.path(QLatin1String(mesh)), inputs.path(QLatin1String(deformation)));
        window->action(CommandId::warp)->trigger();
        if (!wait_for_job()) qFatal("The warp did not end.");
        if (!errors.isEmpty()) qFatal("%s", qPrintable(errors.front()));
        QTest::qWait(50);  // a first frame
    }
    MeshDocument& document() { return window->document(); }
    FilmDialog* show_dialog(int frames) {
        window->action(CommandId::export_film)->trigger();
        auto* dialog = window->findChild<FilmDialog*>();
        if (!dialog || !QTest::qWaitForWindowExposed(dialog)) qFatal("There is no dialog.");
        find<QSpinBox>("film_frames")->setValue(frames);
        find<QCheckBox>("film_caption")->setChecked(false);
        find<QLineEdit>("film_folder")->setText(folder.filePath(QStringLiteral("it")));
        find<QLineEdit>("film_prefix")->setText(QStringLiteral("way"));
        set_size(320, 200);
        return dialog;
    }
    void set_size(int width, int height) {
        find<QCheckBox>("size_keeps")->setChecked(false);
        find<QSpinBox>("size_width")->setValue(width);
        find<QSpinBox>("size_height")->setValue(height);
    }
    void choose_animation(bool is_lossless) {
        find<QComboBox>("film_format")->setCurrentIndex(1);
        find<QCheckBox>("film_lossless")->setChecked(is_lossless);
    }
    QString animation() { return folder.filePath(QStringLiteral("it/way.webp")); }
    DecodedAnimation decoded() { return DecodedAnimation(read_text_file(animation().toStdString())); }
    /// A frame of the animation.
    static QImage image_of(const DecodedAnimation& film, std::size_t frame) {
        return QImage(film.frames[frame].data(), film.width, film.height, 4 * film.width, QImage::Format_RGBA8888)
            .copy();
    }
    void write() {
        click("film_export");
        if (!wait_for_job()) qFatal("The film did not end.");
    }
    QString file(int number) { return film_file(folder.filePath(QStringLiteral("it")), QStringLiteral("way"), number); }
    QImage picture(int number) { return QImage(file(number)).convertToFormat(QImage::Format_RGBA8888); }
    QStringList files() {
        QStringList names = QDir(folder.filePath(QStringLiteral("it"))).entryList(QDir::Files | QDir::Hidden);
        names.sort();
        return names;
    }
    /// What a film shows of a state.
    QImage picture_of(const MeshState& state, bool is_transparent = false) {
        PictureStudio studio(window->view());
        return studio.draw(*state.mesh, state.quality.get(), {.size = {320, 200}, .is_transparent = is_transparent})
            .convertToFormat(QImage::Format_RGBA8888);
    }
};

/// Of a window with the timeline of an untangling.
struct TimelineFilmUnderTest : FilmUnderTest {
    TimelineFilmUnderTest() {
        unsaved_answer = UnsavedAnswer::discard;  // of the motion that is no timeline
        open(inputs.path(QStringLiteral("square.msh")), inputs.path(QStringLiteral("bump.json")));
        if (!window->jobs().deform() || !wait_for_job()) qFatal("The boundary was not deformed.");
        if (!window->jobs().untangle_recorded(SignedAngleOptions{.beta = 0.3, .max_passes = 3}) || !wait_for_job())
            qFatal("Nothing was recorded.");
        QTest::qWait(300);  // the step has settled
    }
    const std::shared_ptr<const Recording>& recording() { return window->player().recording(); }
    void choose_level(StepLevel level) {
        auto* box = find<QComboBox>("film_level");
        box->setCurrentIndex(box->findData(static_cast<int>(level)));
    }
    using FilmUnderTest::picture_of;
    QImage picture_of(const Frame& frame, bool is_highlighted = true) {
        PictureStudio studio(window->view());
        return studio
            .draw(frame.mesh, &*frame.quality, {.size = {320, 200}},
                  is_highlighted ? frame.highlighted : std::vector<Index>())
            .convertToFormat(QImage::Format_RGBA8888);
    }
};

}  // namespace

class FilmTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void it_begins_and_ends_with_the_states() {
        FilmUnderTest test;
        test.show_dialog(5);
        const QImage view = test.window->view().grabFramebuffer();
        test.write();
        QVERIFY(test.errors.isEmpty());
        QCOMPARE(test.files().size(), 5);
        QCOMPARE(test.files().front(), QStringLiteral("way-0001.png"));
        QCOMPARE(test.picture(1), test.picture_of(test.document().original()));
        QCOMPARE(test.picture(5), test.picture_of(test.document().state()));
        for (int i = 1; i < 5; ++i) QVERIFY(test.picture(i) != test.picture(i + 1));
        // In the middle it is a warp by half of the deformation, in the colours of its own certificate.
        const CurvedMesh& mesh = *test.document().original().mesh;
        MeshState middle;
        const Warper warper(mesh, std::get<WarpAction>(test.document().step_action(0)).options);
        const Coordinates half = apply_deformation(mesh, *test.document().deformation()->deformation, 0.5);
        middle.mesh = std::make_shared<const CurvedMesh>(mesh.with_coordinates(warper.move(half).coordinates));
        middle.quality = std::make_shared<const QualityReport>(assess_quality(*middle.mesh));
        QCOMPARE(test.picture(3), test.picture_of(middle));
        // The window has gone on undisturbed.
        QCOMPARE(test.window->view().grabFramebuffer(), view);
        QCOMPARE(test.document().history()->count(), 1);
    }

    void there_and_back_is_a_loop() {
        FilmUnderTest test;
        test.show_dialog(4);
        test.find<QCheckBox>("film_back")->setChecked(true);
        QCOMPARE(test.text("film_duration"), QStringLiteral("6 pictures, 0.2 s"));
        test.write();
        QCOMPARE(test.files().size(), 6);
        QCOMPARE(test.picture(5), test.picture(3));
        QCOMPARE(test.picture(6), test.picture(2));
        // A shorter one of the same name replaces all of it.
        auto* message = test.find<QLabel>("film_message");
        test.find<QCheckBox>("film_back")->setChecked(false);
        QCOMPARE(message->text(), QStringLiteral("6 pictures of this name are there and will be replaced."));
        test.find<QSpinBox>("film_frames")->setValue(2);
        QFile other(test.folder.filePath(QStringLiteral("it/way-old.png")));
        QVERIFY(other.open(QIODevice::WriteOnly));
        other.close();
        test.write();
        QCOMPARE(test.files(), (QStringList{QStringLiteral("way-0001.png"), QStringLiteral("way-0002.png"),
                                            QStringLiteral("way-old.png")}));
    }

    void it_begins_before_the_last_step_on_request() {
        FilmUnderTest test;
        QVERIFY(test.window->jobs().flip());
        QVERIFY(test.wait_for_job());
        QVERIFY(test.window->jobs().warp({}));
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.document().history()->index(), 3);
        test.show_dialog(3);
        test.find<QComboBox>("film_from")->setCurrentIndex(1);
        test.write();
        QVERIFY(test.errors.isEmpty());
        QCOMPARE(test.picture(1), test.picture_of(test.document().before()));
        QCOMPARE(test.picture(3), test.picture_of(test.document().state()));
    }

    void it_can_be_see_through_and_captioned() {
        FilmUnderTest test;
        test.show_dialog(2);
        test.find<QCheckBox>("film_transparent")->setChecked(true);
        test.find<QCheckBox>("film_caption")->setChecked(true);
        test.write();
        const QImage written(test.file(2));
        QVERIFY(written.hasAlphaChannel());
        QCOMPARE(qAlpha(written.pixel(2, 2)), 0);
        // The caption is in the lower left corner, the rest is what it is without.
        const QImage plain = test.picture_of(test.document().state(), true);
        const QRect corner(0, 170, 160, 30);
        QVERIFY(test.picture(2).copy(corner) != plain.copy(corner));
        QCOMPARE(test.picture(2).copy(0, 0, 320, 160), plain.copy(0, 0, 320, 160));
        QVERIFY(test.find<QLineEdit>("film_command")->text().contains(QStringLiteral("yuva420p")));
    }

    void an_animation_is_one_file() {
        FilmUnderTest test;
        test.show_dialog(5);
        QVERIFY(!test.find<QCheckBox>("film_lossless")->isVisible());
        test.write();
        QCOMPARE(test.files().size(), 5);
        test.choose_animation(true);
        QVERIFY(test.find<QCheckBox>("film_lossless")->isVisible());
        test.find<QSpinBox>("film_per_second")->setValue(20);
        test.write();
        QVERIFY2(test.errors.isEmpty(), qPrintable(test.errors.join(QLatin1Char('\n'))));
        QVERIFY(test.find<QLabel>("film_message")->text().contains(QStringLiteral("way.webp")));
        QVERIFY(!test.find<QLineEdit>("film_command")->isVisible());
        // The pictures are still there to compare with, and the same.
        QCOMPARE(test.files().size(), 6);
        const DecodedAnimation film = test.decoded();
        QCOMPARE(QSize(film.width, film.height), QSize(320, 200));
        QCOMPARE(film.frames.size(), std::size_t{5});
        QCOMPARE(film.ends, (std::vector<int>{50, 100, 150, 200, 250}));
        for (int i = 0; i < 5; ++i)
            QCOMPARE(FilmUnderTest::image_of(film, static_cast<std::size_t>(i)), test.picture(i + 1));
        // A message before it is replaced, and there and back in the same frames.
        test.find<QCheckBox>("film_back")->setChecked(true);
        QVERIFY(test.find<QLabel>("film_message")->text().endsWith(QStringLiteral("will be replaced.")));
        test.write();
        const DecodedAnimation loop = test.decoded();
        QCOMPARE(loop.frames.size(), std::size_t{8});
        for (const auto& [place, same] : {std::pair{4, 5}, {5, 4}, {6, 3}, {7, 2}})
            QCOMPARE(FilmUnderTest::image_of(loop, static_cast<std::size_t>(place)), test.picture(same));
    }

    void a_lossy_animation_is_near_and_see_through() {
        FilmUnderTest test;
        test.show_dialog(3);
        test.find<QCheckBox>("film_transparent")->setChecked(true);
        test.write();
        test.choose_animation(false);
        test.find<QSpinBox>("film_quality")->setValue(95);
        test.write();
        const DecodedAnimation film = test.decoded();
        QCOMPARE(film.frames.size(), std::size_t{3});
        QCOMPARE(film.pixel(1, 2, 2)[3], 0);
        for (int i = 0; i < 3; ++i) {
            // Laid on white: what see-through pixels hide does not count.
            QImage pictures[] = {QImage(test.file(i + 1)), FilmUnderTest::image_of(film, static_cast<std::size_t>(i))};
            std::vector<std::uint8_t> bytes[2];
            for (int k = 0; k < 2; ++k) {
                QImage ground(320, 200, QImage::Format_RGBA8888);
                ground.fill(Qt::white);
                QPainter(&ground).drawImage(0, 0, pictures[k]);
                bytes[k].assign(ground.constBits(), ground.constBits() + ground.sizeInBytes());
            }
            QVERIFY(DecodedAnimation::difference(bytes[0], bytes[1]) < 3.0);
        }
        // What was chosen is remembered.
        test.window->findChild<FilmDialog*>()->reject();
        QTRY_VERIFY(!test.window->findChild<FilmDialog*>());
        test.show_dialog(3);
        QCOMPARE(test.find<QComboBox>("film_format")->currentIndex(), 1);
        QCOMPARE(test.find<QSpinBox>("film_quality")->value(), 95);
        test.find<QSpinBox>("film_per_second")->setValue(100);
        QVERIFY(!test.find<QPushButton>("film_export")->isEnabled());
        QVERIFY(test.find<QLabel>("film_message")->text().contains(QStringLiteral("60")));
        test.find<QComboBox>("film_format")->setCurrentIndex(0);
        QVERIFY(test.find<QPushButton>("film_export")->isEnabled());
    }

    void an_animation_that_is_stopped_leaves_nothing() {
        FilmUnderTest test;
        FilmDialog* dialog = test.show_dialog(400);
        test.choose_animation(false);
        auto* message = test.find<QLabel>("film_message");
        test.click("film_export");
        QVERIFY(QTest::qWaitFor([&] { return message->text().contains(QStringLiteral("frame 3 of")); }, 30000));
        dialog->reject();
        QVERIFY(test.wait_for_job());
        QCOMPARE(message->text(), QStringLiteral("Stopped; nothing was written."));
        QCOMPARE(QDir(test.folder.filePath(QStringLiteral("it"))).entryList(QDir::Files | QDir::Hidden), QStringList());
        // A place that cannot be written to is told.
        test.find<QSpinBox>("film_frames")->setValue(2);
        QVERIFY(QDir(test.folder.filePath(QStringLiteral("it"))).mkdir(QStringLiteral("way.webp")));
        test.write();
        QCOMPARE(test.errors.size(), 1);
        QVERIFY2(test.errors[0].contains(QStringLiteral("way.webp")), qPrintable(test.errors[0]));
    }

    void the_steps_of_the_timeline() {
        TimelineFilmUnderTest test;
        const auto recording = test.recording();
        test.show_dialog(6);
        auto* from = test.find<QComboBox>("film_from");
        QCOMPARE(from->currentText(), QStringLiteral("The steps of the timeline"));
        QVERIFY(from->count() > 1 && test.find<QComboBox>("film_level")->isVisible());
        for (const StepLevel level : {StepLevel::pass, StepLevel::patch, StepLevel::iteration}) {
            test.choose_level(level);
            TimelineFrames frames(recording, level, 6, 0, recording->step_count() - 1);
            QVERIFY(test.text("film_duration").startsWith(QStringLiteral("%1 pictures").arg(frames.count())));
            test.write();
            QVERIFY2(test.errors.isEmpty(), qPrintable(test.errors.join(QLatin1Char('\n'))));
            QCOMPARE(test.files().size(), frames.count());
            int outlined = 0;
            for (int i = 0; i < frames.count(); ++i) {
                const Frame frame = frames.make(i, {});
                QCOMPARE(test.picture(i + 1), test.picture_of(frame));
                if (frame.highlighted.empty()) continue;
                ++outlined;
                QVERIFY(test.picture(i + 1) != test.picture_of(frame, false));
            }
            QCOMPARE(outlined > 0, level != StepLevel::pass);
        }
        QCOMPARE(count_steps(*recording, StepLevel::iteration), static_cast<int>(recording->step_count()));
        // As an animation it is the same, and the timeline stays where it was.
        test.choose_animation(true);
        test.write();
        const DecodedAnimation film = test.decoded();
        QCOMPARE(film.frames.size(), std::size_t{6});
        for (int i = 0; i < 6; ++i)
            QCOMPARE(FilmUnderTest::image_of(film, static_cast<std::size_t>(i)), test.picture(i + 1));
        QCOMPARE(test.window->player().recording(), recording);
        QCOMPARE(test.window->player().step(), 0u);
        QCOMPARE(test.document().history()->index(), 2);
    }

    void captions_tell_where_the_timeline_is() {
        TimelineFilmUnderTest test;
        test.show_dialog(3);
        test.choose_level(StepLevel::iteration);
        test.find<QCheckBox>("film_caption")->setChecked(true);
        test.write();
        TimelineFrames frames(test.recording(), StepLevel::iteration, 3, 0, test.recording()->step_count() - 1);
        const QRect corner(0, 170, 200, 30);
        for (int i = 0; i < 3; ++i) {
            const Frame frame = frames.make(i, {});
            const StepNumber step = frames.steps()[static_cast<std::size_t>(i)];
            QCOMPARE(frame.caption, step_caption(*test.recording(), step, frame.quality->summary));
            const QImage plain = test.picture_of(frame);
            QVERIFY(test.picture(i + 1).copy(corner) != plain.copy(corner));
            QCOMPARE(test.picture(i + 1).copy(0, 0, 320, 160), plain.copy(0, 0, 320, 160));
        }
    }

    void a_timeline_that_is_closed_is_no_longer_offered() {
        TimelineFilmUnderTest test;
        test.show_dialog(3);
        auto* rate = test.find<QSpinBox>("film_per_second");
        QCOMPARE(rate->value(), 8);
        rate->setValue(5);
        test.window->action(CommandId::timeline_close)->trigger();
        auto* from = test.find<QComboBox>("film_from");
        QCOMPARE(from->currentText(), QStringLiteral("The mesh as opened"));
        QCOMPARE(rate->value(), 30);
        QVERIFY(!test.find<QComboBox>("film_level")->isVisible());
        QVERIFY(test.find<QSpinBox>("film_frames")->prefix().isEmpty());
        test.write();
        QVERIFY(test.errors.isEmpty());
        QCOMPARE(test.picture(1), test.picture_of(test.document().original()));
        QCOMPARE(test.picture(3), test.picture_of(test.document().state()));
        // Of the history on request while a timeline is open.
        test.window->action(CommandId::timeline_show)->trigger();
        QVERIFY(test.wait_for_job());
        QCOMPARE(from->currentText(), QStringLiteral("The steps of the timeline"));
        QCOMPARE(rate->value(), 5);
        from->setCurrentIndex(1);
        test.write();
        QCOMPARE(test.picture(3), test.picture_of(test.document().state()));
    }

    void a_trace_alone_can_be_filmed() {
        TimelineFilmUnderTest test;
        test.file_answer = test.folder.filePath(QStringLiteral("run.jsonl"));
        test.window->action(CommandId::timeline_save)->trigger();
        QVERIFY(test.wait_for_job());
        test.unsaved_answer = UnsavedAnswer::discard;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(!test.window->action(CommandId::export_film)->isEnabled());
        test.window->action(CommandId::timeline_open)->trigger();
        QVERIFY(test.wait_for_job() && test.errors.isEmpty());
        QVERIFY(test.window->action(CommandId::export_film)->isEnabled());
        QTest::qWait(300);
        test.show_dialog(4);
        QCOMPARE(test.find<QComboBox>("film_from")->count(), 1);
        test.choose_level(StepLevel::patch);
        test.write();
        QVERIFY(test.errors.isEmpty());
        TimelineFrames frames(test.recording(), StepLevel::patch, 4, 0, test.recording()->step_count() - 1);
        for (int i = 0; i < 4; ++i) QCOMPARE(test.picture(i + 1), test.picture_of(frames.make(i, {})));
        // Without it there is nothing to be shown.
        test.window->action(CommandId::timeline_close)->trigger();
        QTRY_VERIFY(!test.window->findChild<FilmDialog*>());
        QVERIFY(!test.window->action(CommandId::export_film)->isEnabled());
    }

    void sizes_are_even() {
        FilmUnderTest test;
        test.show_dialog(2);
        test.set_size(333, 201);
        test.write();
        QCOMPARE(test.picture(1).size(), QSize(332, 200));
    }

    void a_film_that_is_stopped_leaves_whole_pictures() {
        FilmUnderTest test;
        FilmDialog* dialog = test.show_dialog(400);
        test.click("film_export");
        QVERIFY(QTest::qWaitFor([&] { return test.files().size() >= 2; }, 30000));
        QCOMPARE(test.find<QPushButton>("film_close")->text(), QStringLiteral("Stop"));
        dialog->reject();
        QVERIFY(test.wait_for_job());
        QVERIFY(dialog->isVisible());
        const QStringList files = test.files();
        QVERIFY(files.size() >= 2 && files.size() < 400);
        for (const QString& name : files) {
            QVERIFY2(name.startsWith(QStringLiteral("way-")), qPrintable(name));
            QCOMPARE(QImage(test.folder.filePath(QStringLiteral("it/") + name)).size(), QSize(320, 200));
        }
        QVERIFY(test.find<QLabel>("film_message")->text().startsWith(QStringLiteral("Stopped")));
        // The window is closed in the middle of another one.
        test.click("film_export");
        QTest::qWait(30);
        test.document().mark_unchanged();
        test.window->close();
        QVERIFY(!test.window->jobs().runner().is_running());
    }

    void what_cannot_be_written_is_told() {
        FilmUnderTest test;
        test.show_dialog(2);
        test.find<QLineEdit>("film_folder")->setText(QStringLiteral("/proc/nowhere"));
        test.write();
        QCOMPARE(test.errors.size(), 1);
        QVERIFY(test.errors[0].contains(QStringLiteral("/proc/nowhere")));
        test.find<QLineEdit>("film_prefix")->setText(QStringLiteral("a/b"));
        QVERIFY(!test.find<QPushButton>("film_export")->isEnabled());
        test.find<QLineEdit>("film_prefix")->setText(QStringLiteral("way"));
        test.set_size(50000, 50);
        QVERIFY(!test.find<QPushButton>("film_export")->isEnabled());
        QVERIFY(test.find<QLabel>("film_message")->text().contains(QStringLiteral("cannot be drawn")));
    }

    void a_deformation_that_is_gone_is_told() {
        FilmUnderTest test;
        // Another one is loaded, and the file of the warp is gone: its nodes go straight.
        test.window->jobs().load_deformation(test.inputs.path(QStringLiteral("bump.json")));
        QVERIFY(test.wait_for_job());
        QFile::remove(test.inputs.path(QStringLiteral("gentle.json")));
        test.show_dialog(3);
        test.write();
        QVERIFY(test.errors.isEmpty());
        QVERIFY2(test.find<QLabel>("film_message")->text().contains(QStringLiteral("go straight")),
                 qPrintable(test.find<QLabel>("film_message")->text()));
        QCOMPARE(test.files().size(), 3);
    }

    void the_line_for_a_video_is_copied_and_run() {
        QCOMPARE(
            video_command(QStringLiteral("/a b/it's 5%"), QStringLiteral("way"), 24, false),
            QStringLiteral("ffmpeg -framerate 24 -i '/a b/it'\\''s 5%%/way-%04d.png' -c:v libx264 -pix_fmt yuv420p "
                           "'/a b/it'\\''s 5%/way.mp4'"));
        FilmUnderTest test;
        // A program that is called ffmpeg, writes its last argument, or fails if that is called so.
        const QString tools = test.folder.filePath(QStringLiteral("bin"));
        QVERIFY(QDir().mkpath(tools));
        QFile tool(tools + QStringLiteral("/ffmpeg"));
        QVERIFY(tool.open(QIODevice::WriteOnly));
        tool.write(
            "#!/bin/sh\nfor last; do :; done\n[ -e \"$(dirname \"$last\")/fail\" ] && { echo no such codec; exit 1; }\n"
            "echo \"$@\" > \"$last\"\n");
        tool.setPermissions(QFile::ReadOwner | QFile::ExeOwner | QFile::WriteOwner);
        tool.close();
        const QByteArray path = qgetenv("PATH");
        qputenv("PATH", QFile::encodeName(tools) + ':' + path);
        test.show_dialog(2);
        test.write();
        qputenv("PATH", QFile::encodeName(tools) + ':' + path);
        test.click("film_copy");
        QCOMPARE(QGuiApplication::clipboard()->text(), test.find<QLineEdit>("film_command")->text());
        QVERIFY(QGuiApplication::clipboard()->text().contains(test.folder.filePath(QStringLiteral("it/way-%04d.png"))));
        test.click("film_video");
        QTRY_VERIFY(test.find<QLabel>("film_message")->text().endsWith(QStringLiteral("way.mp4 is there.")));
        QVERIFY(QFile::exists(test.folder.filePath(QStringLiteral("it/way.mp4"))));
        QFile fail(test.folder.filePath(QStringLiteral("it/fail")));
        QVERIFY(fail.open(QIODevice::WriteOnly));
        fail.close();
        test.click("film_video");
        QTRY_VERIFY(test.find<QLabel>("film_message")->text().endsWith(QStringLiteral("no such codec")));
        qputenv("PATH", path);
    }
};

QObject* make_test() {
    return new FilmTest;
}

#include "film_test.moc"
