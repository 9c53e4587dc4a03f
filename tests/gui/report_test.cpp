/// Reports: the same from the window and from the command line, well formed, and what is told of them.

#include <QDesktopServices>
#include <QDir>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QProcess>
#include <QPushButton>
#include <QRegularExpression>
#include <QSettings>
#include <QUrl>
#include <QXmlStreamReader>

#include "core/io/mesh_io.h"
#include "tests/gui/gui_test_support.h"
#include "tests/support/mesh_factory.h"
#include "ui/jobs/reporting.h"
#include "ui/panels/banner.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

QByteArray content(const QString& path) {
    QFile file(path);
    if (!file.open(QIODevice::ReadOnly)) qFatal("%s is not there.", qPrintable(path));
    return file.readAll();
}

QJsonObject json_of(const QString& folder) {
    return QJsonDocument::fromJson(content(folder + QStringLiteral("/report.json"))).object();
}

QJsonObject without_run(QJsonObject json) {
    if (!json.contains(QStringLiteral("run"))) qFatal("The report has no block of the run.");
    json.remove(QStringLiteral("run"));
    return json;
}

QString html_without_run(const QString& folder) {
    QString html = QString::fromUtf8(content(folder + QStringLiteral("/report.html")));
    const QRegularExpression run(QStringLiteral("<section id=\"run\">.*?</section>"),
                                 QRegularExpression::DotMatchesEverythingOption);
    if (!html.contains(run)) qFatal("The report has no section of the run.");
    return html.remove(run);
}

struct ReportUnderTest : WindowUnderTest {
    QTemporaryDir folder;
    QString mesh_path = folder.filePath(QStringLiteral("part.msh"));

    ReportUnderTest() {
        write_mesh(mesh_path.toStdString(), bulged_square_mesh(4, 3, 0.12));
        QDir(folder.path()).mkdir(QStringLiteral("window"));
        file_answer = window_folder();
    }
    QString window_folder() const { return folder.filePath(QStringLiteral("window")); }
    QString cli_folder() const { return folder.filePath(QStringLiteral("cli")); }
    bool untangle(const UntangleOptions& options) { return window->jobs().untangle(options) && wait_for_job(); }
    bool report() {
        window->action(CommandId::report)->trigger();
        return wait_for_job();
    }
    bool report_by_command_line(const QStringList& options) {
        QProcess process;
        process.start(
            QStringLiteral(CURVEWRIGHT_CLI),
            QStringList{QStringLiteral("untangle"), mesh_path, QStringLiteral("-o"),
                        folder.filePath(QStringLiteral("out.vtu")), QStringLiteral("--report"), cli_folder()} +
                options);
        return process.waitForFinished(60000) && process.exitStatus() == QProcess::NormalExit &&
               (process.exitCode() == 0 || process.exitCode() == 3);
    }
};

}  // namespace

class ReportTest : public QObject {
    Q_OBJECT

  public slots:
    /// Instead of the browser.
    void take(const QUrl& url) { opened_ = url; }

  private slots:
    void initTestCase() { QDesktopServices::setUrlHandler(QStringLiteral("file"), this, "take"); }
    void init() { QSettings().clear(); }

    void it_is_that_of_the_command_line_data() {
        QTest::addColumn<int>("method");
        QTest::addColumn<QStringList>("arguments");
        QTest::newRow("guaranteed") << 0 << QStringList{QStringLiteral("--target"), QStringLiteral("0.8")};
        QTest::newRow("signed angles") << 1 << QStringList{QStringLiteral("--beta"), QStringLiteral("auto")};
        QTest::newRow("unsigned angles") << 2
                                         << QStringList{QStringLiteral("--method"), QStringLiteral("unsigned-angle")};
    }
    void it_is_that_of_the_command_line() {
        QFETCH(int, method);
        QFETCH(QStringList, arguments);
        GuaranteedOptions guaranteed;
        guaranteed.target = 0.8;
        SignedAngleOptions signed_angles;
        signed_angles.beta_choice = BetaChoice::automatic;
        const UntangleOptions options = method == 0   ? UntangleOptions(guaranteed)
                                        : method == 1 ? UntangleOptions(signed_angles)
                                                      : UntangleOptions(UnsignedAngleOptions());
        ReportUnderTest test;
        test.open(test.mesh_path);
        QVERIFY(test.untangle(options));
        QVERIFY(test.report());
        QVERIFY2(test.errors.isEmpty(), qPrintable(test.errors.join(QLatin1Char('\n'))));
        QVERIFY(test.report_by_command_line(arguments));
        const QJsonObject ours = json_of(test.window_folder()), theirs = json_of(test.cli_folder());
        QCOMPARE(without_run(ours), without_run(theirs));
        QCOMPARE(html_without_run(test.window_folder()), html_without_run(test.cli_folder()));
        QVERIFY(ours[QStringLiteral("pictures")][QStringLiteral("count")].toInt() >= 4);
        QCOMPARE(ours[QStringLiteral("input")][QStringLiteral("file")].toString(), QStringLiteral("part.msh"));
        QVERIFY(ours[QStringLiteral("run")][QStringLiteral("remarks")].toArray().isEmpty());
        // The history is as it was.
        QCOMPARE(test.window->document().history()->count(), 1);
    }

    void it_is_well_formed() {
        ReportUnderTest test;
        test.open(test.mesh_path);
        QVERIFY(test.untangle(GuaranteedOptions()));
        QVERIFY(test.report());
        QXmlStreamReader reader(content(test.window_folder() + QStringLiteral("/report.html")));
        int pictures = 0, charts = 0;
        QStringList ids;
        while (!reader.atEnd()) {
            if (reader.readNext() != QXmlStreamReader::StartElement) continue;
            pictures += reader.name() == QLatin1String("img") ? 1 : 0;
            charts += reader.name() == QLatin1String("svg") ? 1 : 0;
            const QXmlStreamAttributes attributes = reader.attributes();
            if (attributes.hasAttribute(QLatin1String("id"))) ids << attributes.value(QLatin1String("id")).toString();
            // Nothing is fetched from anywhere.
            const auto source = attributes.value(QLatin1String("src"));
            QVERIFY(source.isEmpty() || source.startsWith(QLatin1String("data:image/png;base64,")));
            QVERIFY(!attributes.hasAttribute(QLatin1String("href")));
        }
        QVERIFY2(!reader.hasError(), qPrintable(reader.errorString()));
        QCOMPARE(pictures, json_of(test.window_folder())[QStringLiteral("pictures")][QStringLiteral("count")].toInt());
        QVERIFY(charts >= 5);
        QCOMPARE(QSet<QString>(ids.begin(), ids.end()).size(), ids.size());
    }

    void it_is_offered_to_be_opened() {
        ReportUnderTest test;
        QVERIFY(!test.window->action(CommandId::report)->isEnabled());
        test.open(test.mesh_path);
        QVERIFY(!test.window->action(CommandId::report)->isEnabled());
        QVERIFY(test.untangle(GuaranteedOptions()));
        QVERIFY(test.window->action(CommandId::report)->isEnabled());
        // Whoever gives up gets none.
        test.file_answer.clear();
        QVERIFY(test.report());
        QVERIFY(QDir(test.window_folder()).isEmpty());
        test.file_answer = test.window_folder();
        QVERIFY(test.report());
        auto* banner = test.find<Banner>("banner");
        QVERIFY(banner->isVisible());
        QVERIFY2(banner->text().contains(QStringLiteral("window/report.html")), qPrintable(banner->text()));
        QCOMPARE(test.find<QPushButton>("banner_action")->text(), QStringLiteral("Open"));
        test.click("banner_action");
        QCOMPARE(opened_, QUrl::fromLocalFile(test.window_folder() + QStringLiteral("/report.html")));
        // A second one does not overwrite the first.
        const QByteArray first = content(test.window_folder() + QStringLiteral("/report.html"));
        QVERIFY(test.report());
        QVERIFY(banner->text().contains(QStringLiteral("window/part-report/report.html")));
        QCOMPARE(content(test.window_folder() + QStringLiteral("/report.html")), first);
        // After the next step it is gone, and after undoing the untangling there is nothing to report.
        test.window->action(CommandId::undo)->trigger();
        QVERIFY(!banner->isVisible());
        QVERIFY(!test.window->action(CommandId::report)->isEnabled());
    }

    void the_banner_flips_again_afterwards() {
        ReportUnderTest test;
        test.unsaved_answer = UnsavedAnswer::discard;
        test.open(test.mesh_path);
        QVERIFY(test.untangle(GuaranteedOptions()));
        QVERIFY(test.report());
        test.open(test.inputs.path(QStringLiteral("clockwise.msh")));
        QVERIFY(test.find<Banner>("banner")->isVisible());
        test.click("banner_action");
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.window->document().history()->count(), 1);
        QVERIFY(!test.find<Banner>("banner")->isVisible());
    }

    void it_tells_what_was_done_before_and_since() {
        ReportUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")), test.inputs.path(QStringLiteral("bump.json")));
        test.window->action(CommandId::deform)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY(test.untangle(GuaranteedOptions()));
        test.window->action(CommandId::deform)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY(test.report());
        const QJsonObject json = json_of(test.window_folder()), input = json[QStringLiteral("input")].toObject();
        const QJsonArray steps = input[QStringLiteral("steps")].toArray();
        QCOMPARE(steps.size(), 1);
        QCOMPARE(steps[0][QStringLiteral("deformation")].toString(), QStringLiteral("bump.json"));
        QVERIFY(json[QStringLiteral("method")][QStringLiteral("command")].isNull());
        QCOMPARE(input[QStringLiteral("sha256")].toString().size(), 64);
        // It is about the untangling, not about the step after it.
        const QualitySummary& summary = test.window->document().state_at(2).quality->summary;
        const QJsonValue after = json[QStringLiteral("after")][QStringLiteral("scaled_jacobian")];
        QCOMPARE(after[QStringLiteral("min")].toDouble(), summary.min);
        QVERIFY(!content(test.window_folder() + QStringLiteral("/report.html"))
                     .contains(test.inputs.path(QString()).toUtf8()));
    }

    void a_file_that_has_changed_has_no_checksum() {
        ReportUnderTest test;
        test.open(test.mesh_path);
        QVERIFY(test.untangle(GuaranteedOptions()));
        write_mesh(test.mesh_path.toStdString(), square_mesh(4, 3));
        QVERIFY(test.report());
        QJsonObject input = json_of(test.window_folder())[QStringLiteral("input")].toObject();
        QVERIFY(input[QStringLiteral("sha256")].isNull());
        QCOMPARE(input[QStringLiteral("note")].toString(),
                 QStringLiteral("The file is not as it was opened any more."));
        QVERIFY(QFile::remove(test.mesh_path));
        QVERIFY(test.report());
        input = json_of(test.window_folder() + QStringLiteral("/part-report"))[QStringLiteral("input")].toObject();
        QCOMPARE(input[QStringLiteral("note")].toString(), QStringLiteral("The file cannot be read any more."));
    }

    void stopping_leaves_nothing() {
        ReportUnderTest test;
        test.open(test.mesh_path);
        QVERIFY(test.untangle(GuaranteedOptions()));
        const QString folder = test.folder.filePath(QStringLiteral("new"));
        test.file_answer = folder;
        test.window->action(CommandId::report)->trigger();
        QVERIFY(test.window->jobs().runner().is_running());
        test.window->action(CommandId::stop)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY(!QFileInfo::exists(folder));
        QVERIFY(test.errors.isEmpty());
        // And in the middle of the pictures.
        int drawn = 0;
        ReportRequest request;
        request.folder = folder;
        request.colors = {[](double) { return std::string("#000000"); }, "#000000", "#000000"};
        request.draw = [&](const ReportedStates&, const PictureWish&) {
            if (++drawn == 2) test.window->jobs().runner().cancel();
            return std::string("picture");
        };
        bool is_told = false;
        request.then = [&](const QString&, const QString&) { is_told = true; };
        QVERIFY(test.window->jobs().write_report(std::move(request)));
        QVERIFY(test.wait_for_job());
        QCOMPARE(drawn, 2);
        QVERIFY(!is_told);
        QVERIFY(!QFileInfo::exists(folder));
    }

    void a_bad_folder_is_told() {
        ReportUnderTest test;
        test.open(test.mesh_path);
        QVERIFY(test.untangle(GuaranteedOptions()));
        test.file_answer = test.mesh_path;
        QVERIFY(test.report());
        QCOMPARE(test.errors.size(), 1);
        QVERIFY2(test.errors.front().contains(QStringLiteral("something else")), qPrintable(test.errors.front()));
        test.file_answer = test.folder.filePath(QStringLiteral("no/such"));
        QVERIFY(test.report());
        QCOMPARE(test.errors.size(), 2);
    }

    void without_pictures_it_is_written_all_the_same() {
        ReportUnderTest test;
        test.open(test.mesh_path);
        QVERIFY(test.untangle(GuaranteedOptions()));
        ReportRequest request;
        request.folder = test.window_folder();
        request.colors = {[](double) { return std::string("#000000"); }, "#000000", "#000000"};
        request.draw = [](const ReportedStates&, const PictureWish&) -> std::string {
            throw Unsupported("No graphics here.");
        };
        QString told;
        request.then = [&](const QString&, const QString& remark) { told = remark; };
        QVERIFY(test.window->jobs().write_report(std::move(request)));
        QVERIFY(test.wait_for_job());
        QCOMPARE(told, QStringLiteral("It has no pictures: No graphics here."));
        const QJsonValue pictures = json_of(test.window_folder())[QStringLiteral("pictures")];
        QCOMPARE(pictures[QStringLiteral("count")].toInt(), 0);
        QCOMPARE(pictures[QStringLiteral("note")].toString(), QStringLiteral("No graphics here."));
    }

  private:
    QUrl opened_;
};

QObject* make_test() {
    return new ReportTest;
}

#include "report_test.moc"
