/// Before and after as bars: brushing, marks of what is selected, groups, following a drag, files.

#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QImage>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QSettings>
#include <QSvgRenderer>
#include <QTreeWidget>

#include "tests/gui/drag_under_test.h"
#include "ui/document/mesh_text.h"
#include "ui/document/number_format.h"
#include "ui/palette/quality_colors.h"
#include "ui/panels/histogram_widget.h"
#include "ui/panels/quality_panel.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

/// A window with a mesh whose boundary was bent so far that elements are tangled.
struct BarsUnderTest : DragUnderTest {
    QTemporaryDir folder;

    BarsUnderTest() {
        QFile file(folder.filePath(QStringLiteral("bends.json")));
        if (!file.open(QIODevice::WriteOnly)) qFatal("There is no place for a file.");
        file.write(
            R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 0.06 * sin(4 * pi * x)^2"},
                    {"group": "top", "type": "expression", "y": "y + 0.03 * x * sin(3 * pi * x)"}]})json");
        file.close();
        open(inputs.path(QStringLiteral("square.msh")), file.fileName());
        window->action(CommandId::deform)->trigger();
        if (!wait_for_job() || now().summary.invalid == 0) qFatal("Nothing is tangled.");
        QTest::qWait(50);
    }
    const QualityReport& now() { return *document().state().quality; }
    HistogramWidget& before_bars() { return *find<HistogramWidget>("before_histogram"); }
    HistogramWidget& bars() { return *find<HistogramWidget>("after_histogram"); }
    void check(const char* name, bool is_on) { find<QCheckBox>(name)->setChecked(is_on); }

    static QPoint place(const HistogramWidget& widget, int bar) {
        QPointF at = widget.drawing().bar_area(bar).center();
        at.setY(widget.drawing().plot().bottom() - 3);
        return at.toPoint();
    }
    static void move(HistogramWidget& widget, QPoint at, Qt::KeyboardModifiers modifiers = {}) {
        QMouseEvent event(QEvent::MouseMove, at, widget.mapToGlobal(at), Qt::NoButton, Qt::LeftButton, modifiers);
        QApplication::sendEvent(&widget, &event);
    }
    void brush(HistogramWidget& widget, int first, int last, Qt::KeyboardModifiers modifiers = {}) {
        const QPoint from = place(widget, first), to = place(widget, last);
        QTest::mousePress(&widget, Qt::LeftButton, modifiers, from);
        for (int step = 1; step <= 6; ++step) move(widget, from + (to - from) * step / 6, modifiers);
        QTest::mouseRelease(&widget, Qt::LeftButton, modifiers, to);
    }
    /// Elements of a report in a range of bars, the tangled ones being bar -1.
    static IndexSet expected(const QualityReport& report, int first, int last) {
        IndexSet result;
        for (std::size_t i = 0; i < report.elements.size(); ++i) {
            const ElementQuality& quality = report.elements[i];
            const int bar =
                quality.validity == Validity::invalid ? -1 : std::clamp(int(25 * quality.scaled_jacobian), 0, 24);
            if (bar >= first && bar <= last) result.push_back(static_cast<Index>(i));
        }
        return result;
    }
    /// The n-th bar with elements in it, from the left.
    static int filled_bar(const HistogramWidget& widget, int number) {
        for (int bar = -1; bar < HistogramBars::bins; ++bar)
            if (widget.bars().at(bar).count() > 0 && number-- == 0) return bar;
        qFatal("There are not so many bars.");
    }
    static QStringList texts(const QTreeWidgetItem& item) {
        QStringList result;
        for (int column = 0; column < item.columnCount(); ++column) result << item.text(column);
        return result;
    }
    static QString change(const QString& before, const QString& now) {
        return before == now ? now : before + QStringLiteral(" → ") + now;
    }
    /// What the table has to say of a group.
    QStringList expected_line(const GroupLine& group, const QualityReport& before, const QualityReport& after) {
        const QualitySummary was = summary_by_hand(before, group.elements), is = summary_by_hand(after, group.elements);
        return {group.name, format_count(static_cast<long long>(group.elements.size())),
                change(format_number(was.min), format_number(is.min)),
                change(format_number(was.mean), format_number(is.mean)),
                change(format_count(was.invalid), format_count(is.invalid))};
    }
    static QualitySummary summary_by_hand(const QualityReport& report, const std::vector<Index>& elements) {
        QualitySummary sum;
        sum.min = 1e300;
        sum.max = -1e300;
        for (const Index element : elements) {
            const ElementQuality& quality = report.elements[static_cast<std::size_t>(element)];
            sum.min = std::min(sum.min, quality.scaled_jacobian);
            sum.max = std::max(sum.max, quality.scaled_jacobian);
            sum.mean += quality.scaled_jacobian / static_cast<double>(elements.size());
            if (quality.validity == Validity::invalid) ++sum.invalid;
        }
        return sum;
    }
    /// Groups whose elements the table speaks of.
    QVector<GroupLine> groups() {
        QVector<GroupLine> lines = list_groups(topology());
        lines.removeIf([](const GroupLine& line) { return line.elements.empty(); });
        return lines;
    }
    /// Exports to a file, through the button, and gives back what is in it.
    QByteArray exported(const QString& name, const QString& filter = {}) {
        file_answer = folder.filePath(name);
        filter_answer = filter;
        click("export_histogram");
        QFile file(folder.filePath(name));
        return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
    }
};

}  // namespace

class HistogramTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().remove(QStringLiteral("quality")); }

    void a_brush_selects_its_elements() {
        BarsUnderTest test;
        const QualityReport& report = test.now();
        const EditState& edit = test.window->edit();
        const int second = BarsUnderTest::filled_bar(test.bars(), 1), third = BarsUnderTest::filled_bar(test.bars(), 2);
        test.brush(test.bars(), -1, second);
        QVERIFY(report.summary.invalid > 0);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, -1, second));
        QVERIFY(edit.elements().size() > static_cast<std::size_t>(report.summary.invalid));
        // Backwards, and beyond the end.
        test.brush(test.bars(), third, second);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, second, third));
        const QPoint from = BarsUnderTest::place(test.bars(), second);
        QTest::mousePress(&test.bars(), Qt::LeftButton, {}, from);
        BarsUnderTest::move(test.bars(), QPoint(test.bars().width() + 50, -20));
        QTest::mouseRelease(&test.bars(), Qt::LeftButton, {}, from);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, second, 24));
        // A brush that comes back gives back what it has passed.
        QTest::mousePress(&test.bars(), Qt::LeftButton, {}, from);
        BarsUnderTest::move(test.bars(), BarsUnderTest::place(test.bars(), 24));
        BarsUnderTest::move(test.bars(), from);
        QTest::mouseRelease(&test.bars(), Qt::LeftButton, {}, from);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, second, second));
        // Moving without a button takes nothing.
        const QPointF away = BarsUnderTest::place(test.bars(), 24);
        QMouseEvent idle(QEvent::MouseMove, away, test.bars().mapToGlobal(away), Qt::NoButton, Qt::NoButton, {});
        QApplication::sendEvent(&test.bars(), &idle);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, second, second));
    }

    void clicks_take_add_and_extend() {
        BarsUnderTest test;
        const QualityReport& report = test.now();
        const EditState& edit = test.window->edit();
        const int second = BarsUnderTest::filled_bar(test.bars(), 1), third = BarsUnderTest::filled_bar(test.bars(), 2);
        const auto click = [&](int bar, Qt::KeyboardModifiers modifiers) {
            QTest::mouseClick(&test.bars(), Qt::LeftButton, modifiers, BarsUnderTest::place(test.bars(), bar));
        };
        click(-1, {});
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, -1, -1));
        click(third, Qt::ControlModifier);
        QCOMPARE(edit.elements(),
                 united(BarsUnderTest::expected(report, -1, -1), BarsUnderTest::expected(report, third, third)));
        click(third, {});
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, third, third));
        click(second, Qt::ShiftModifier);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, second, third));
        // The bars of before have other elements.
        const QualityReport& before = *test.document().before().quality;
        const int bar = BarsUnderTest::filled_bar(test.before_bars(), 0);
        QTest::mouseClick(&test.before_bars(), Qt::LeftButton, {}, BarsUnderTest::place(test.before_bars(), bar));
        QCOMPARE(edit.elements(), BarsUnderTest::expected(before, bar, bar));
        QVERIFY(edit.elements() != BarsUnderTest::expected(report, bar, bar));
    }

    void keys_draw_a_range() {
        BarsUnderTest test;
        const QualityReport& report = test.now();
        const EditState& edit = test.window->edit();
        const int first = BarsUnderTest::filled_bar(test.bars(), 0), third = BarsUnderTest::filled_bar(test.bars(), 2);
        test.bars().setFocus(Qt::TabFocusReason);
        QTest::keyClick(&test.bars(), Qt::Key_Home);
        QTest::keyClick(&test.bars(), Qt::Key_Right, Qt::ShiftModifier);
        QTest::keyClick(&test.bars(), Qt::Key_Right, Qt::ShiftModifier);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, first, third));
        QTest::keyClick(&test.bars(), Qt::Key_End, Qt::ShiftModifier);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, first, 24));
        QTest::keyClick(&test.bars(), Qt::Key_Home);
        QTest::keyClick(&test.bars(), Qt::Key_Return);
        QCOMPARE(edit.elements(), BarsUnderTest::expected(report, first, first));
        QTest::keyClick(&test.bars(), Qt::Key_End);
        QTest::keyClick(&test.bars(), Qt::Key_Return, Qt::ControlModifier);
        const int last = test.bars().bars().bar_of_element[static_cast<std::size_t>(report.worst(32).back())];
        QCOMPARE(edit.elements(),
                 united(BarsUnderTest::expected(report, first, first), BarsUnderTest::expected(report, last, last)));
    }

    void what_the_view_selects_is_marked_in_the_bars() {
        BarsUnderTest test;
        const Index element = test.now().worst(32).back();
        const auto bar = test.bars().bars().bar_of_element[static_cast<std::size_t>(element)];
        test.window->action(CommandId::tool_look)->trigger();
        test.window->edit().select({}, {});
        QTest::mouseMove(&test.view(), QPoint(3, 3));
        QCOMPARE(test.bars().bars().at(bar).selected, 0);
        const auto foot_of = [](HistogramWidget& widget, int its) {
            const QImage image = widget.grab().toImage();
            return image.pixelColor(BarsUnderTest::place(widget, its) + QPoint(0, 1));
        };
        const QColor plain = foot_of(test.bars(), bar);
        const auto bar_before = test.before_bars().bars().bar_of_element[static_cast<std::size_t>(element)];
        const QColor plain_before = foot_of(test.before_bars(), bar_before);
        const Eigen::RowVector3d center = test.document().state().mesh->element_center(element);
        QTest::mouseClick(&test.view(), Qt::LeftButton, {}, test.view().to_display(center).toPoint());
        QCOMPARE(test.window->edit().elements(), IndexSet{element});
        QCOMPARE(test.bars().bars().at(bar).selected, 1);
        QCOMPARE(test.before_bars().bars().at(bar_before).selected, 1);
        QVERIFY(foot_of(test.bars(), bar).lightness() < plain.lightness() - 40);
        QVERIFY(foot_of(test.before_bars(), bar_before).lightness() < plain_before.lightness() - 40);
        // Marks follow the elements to other bars.
        test.click("tool_undo");
        QCOMPARE(test.bars().bars().at(bar_before).selected, 1);
        test.window->edit().select({}, {});
        QCOMPARE(test.bars().bars().at(bar_before).selected, 0);
        QCOMPARE(foot_of(test.bars(), bar_before), plain_before);
    }

    void one_over_the_other_is_remembered() {
        {
            BarsUnderTest test;
            const Index limit = test.bars().limit();
            QCOMPARE(test.before_bars().limit(), limit);
            QVERIFY(!test.bars().drawing().outline);
            test.check("overlay_bars", true);
            QVERIFY(!test.before_bars().isVisible());
            QVERIFY(test.bars().isVisible());
            QCOMPARE(test.bars().limit(), limit);
            const auto& outline = test.bars().drawing().outline;
            QVERIFY(outline.has_value());
            const HistogramBars expected = make_bars(test.document().before().quality->elements);
            for (int bar = -1; bar < HistogramBars::bins; ++bar)
                QCOMPARE(outline->at(bar).count(), expected.at(bar).count());
            // The line stands where there is no bar now.
            const int bar = BarsUnderTest::filled_bar(test.before_bars(), 0);
            const QRectF area = test.bars().drawing().bar_area(bar);
            QTest::qWait(20);
            const QImage with = test.bars().grab().toImage();
            const double top =
                area.bottom() - test.bars().drawing().height_of(expected.at(bar).count()) * area.height();
            bool is_drawn = false;
            for (int y = int(top) - 2; y <= int(top) + 2; ++y)
                is_drawn |= with.pixelColor(int(area.center().x()), y) == theme().color(QStringLiteral("text"));
            QVERIFY(is_drawn);
            QVERIFY(test.text("before_validity").contains(QStringLiteral("valid")));
            QVERIFY(test.find<QLabel>("before_figures")->isVisible());
            test.find<QComboBox>("compare_with")->setCurrentIndex(1);
            QVERIFY(test.bars().drawing().outline.has_value());
        }
        WindowUnderTest again;
        QVERIFY(again.find<QCheckBox>("overlay_bars")->isChecked());
        again.open(again.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(!again.find<HistogramWidget>("before_histogram")->isVisible());
        again.find<QCheckBox>("overlay_bars")->setChecked(false);
        QVERIFY(again.find<HistogramWidget>("before_histogram")->isVisible());
        QVERIFY(!again.find<HistogramWidget>("after_histogram")->drawing().outline);
        // A mesh without a quality has no bars, and nothing to export.
        again.open(again.inputs.path(QStringLiteral("quad.msh")));
        const bool has_quality = again.window->document().state().quality != nullptr;
        QCOMPARE(again.find<HistogramWidget>("after_histogram")->has_data(), has_quality);
        QCOMPARE(again.window->action(CommandId::export_quality)->isEnabled(), has_quality);
    }

    void groups_have_their_figures() {
        BarsUnderTest test;
        auto* table = test.find<QTreeWidget>("group_figures");
        QVERIFY(!table->isVisible());
        test.check("show_group_figures", true);
        QVERIFY(table->isVisible());
        const QVector<GroupLine> groups = test.groups();
        QCOMPARE(groups.size(), 5);
        QCOMPARE(table->topLevelItemCount(), 6);
        const QualityReport& before = *test.document().before().quality;
        for (int row = 0; row < 5; ++row)
            QCOMPARE(BarsUnderTest::texts(*table->topLevelItem(row + 1)),
                     test.expected_line(groups[row], before, test.now()));
        GroupLine all{QStringLiteral("all elements"), 2, {}, {}};
        for (Index i = 0; i < 32; ++i) all.elements.push_back(i);
        QCOMPARE(BarsUnderTest::texts(*table->topLevelItem(0)), test.expected_line(all, before, test.now()));
        QVERIFY(table->topLevelItem(0)->text(4).startsWith(QStringLiteral("0 → ")));
        // A click takes the group's elements, and so does a key.
        for (const int row : {1, 2, 5}) {
            const QRect place = table->visualItemRect(table->topLevelItem(row));
            table->scrollToItem(table->topLevelItem(row));
            QTest::mouseClick(table->viewport(), Qt::LeftButton, {},
                              table->visualItemRect(table->topLevelItem(row)).center());
            IndexSet elements = groups[row - 1].elements;
            std::sort(elements.begin(), elements.end());
            QVERIFY(!place.isEmpty() && !elements.empty());
            QCOMPARE(test.window->edit().elements(), elements);
        }
        table->setFocus(Qt::TabFocusReason);
        for (int row = 5; row > 0; --row) QTest::keyClick(table, Qt::Key_Up);
        QTest::keyClick(table, Qt::Key_Return);
        QCOMPARE(test.window->edit().elements(), all.elements);
        // Everything fits into the window as it is at first, and into a small one.
        QCOMPARE(test.window->width(), 1280);
        test.window->resize(1024, 700);
        QTest::qWait(20);
        QCOMPARE(test.window->width(), 1024);
    }

    void bars_and_groups_follow_every_frame_of_a_drag() {
        BarsUnderTest test;
        test.check("show_group_figures", true);
        auto* table = test.find<QTreeWidget>("group_figures");
        const QVector<GroupLine> groups = test.groups();
        int frames = 0, different = 0;
        QStringList wrong;
        const QualityReport start = test.now();
        const auto connection =
            connect(&test.drag(), &LiveDrag::frame, this, [&](const Coordinates&, const QualityReport* quality) {
                if (!quality) return;
                ++frames;
                const HistogramBars expected = make_bars(quality->elements);
                if (test.bars().bars().bar_of_element != expected.bar_of_element) wrong << QStringLiteral("bars");
                // Compared with what the drag began from.
                if (test.before_bars().bars().bar_of_element != make_bars(start.elements).bar_of_element)
                    wrong << QStringLiteral("before");
                if (expected.bar_of_element != make_bars(start.elements).bar_of_element) ++different;
                for (int row = 0; row < groups.size(); ++row)
                    if (BarsUnderTest::texts(*table->topLevelItem(row + 1)) !=
                        test.expected_line(groups[row], start, *quality))
                        wrong << groups[row].name;
            });
        test.take(test.node_at(1.0, 0.5));
        test.move_by({40, 0});
        test.let_go();
        disconnect(connection);
        QVERIFY(frames >= 2);
        QVERIFY(different >= 1);
        QVERIFY2(wrong.isEmpty(), qPrintable(wrong.join(QLatin1Char(' '))));
        // The document's state stays.
        QCOMPARE(test.bars().bars().bar_of_element, make_bars(test.now().elements).bar_of_element);
    }

    void steps_are_shown_from_plain_spans() {
        BarsUnderTest test;
        auto* panel = test.window->findChild<QualityPanel*>();
        const QualityReport &before = *test.document().before().quality, &now = test.now();
        {
            const std::vector<ElementQuality> first = now.elements, second = before.elements;
            panel->show_live(second, QualityPanel::Qualities(first));
        }
        QCOMPARE(test.before_bars().bars().bar_of_element, make_bars(now.elements).bar_of_element);
        QCOMPARE(test.bars().bars().bar_of_element, make_bars(before.elements).bar_of_element);
        QCOMPARE(test.bars().limit(), test.before_bars().limit());
        panel->show_state();
        QCOMPARE(test.bars().bars().bar_of_element, make_bars(now.elements).bar_of_element);
    }

    void the_table_of_a_file_has_the_right_numbers() {
        BarsUnderTest test;
        test.brush(test.bars(), -1, 24);
        const QByteArray bytes = test.exported(QStringLiteral("bars.csv"));
        QVERIFY(test.errors.isEmpty());
        QStringList lines = QString::fromUtf8(bytes).split(QLatin1Char('\n'));
        QVERIFY(lines.takeLast().isEmpty());
        const QStringList head = lines.takeFirst().split(QLatin1Char(','));
        const QualityReport &before = *test.document().before().quality, &now = test.now();
        QCOMPARE(lines.size(), 26 + 1 + 5);
        const auto value = [&](int line, const char* column) {
            const QStringList fields = lines[line].split(QLatin1Char(','));
            const auto place = head.indexOf(QLatin1String(column));
            if (place < 0 || fields.size() != head.size()) qFatal("The table is no table.");
            return fields[place];
        };
        for (int line = 0; line < 26; ++line) {
            const int bar = line - 1;
            QCOMPARE(value(line, "part"), QStringLiteral("bin"));
            if (bar >= 0) {
                QCOMPARE(value(line, "lower").toDouble(), bar / 25.0);
                QCOMPARE(value(line, "upper").toDouble(), (bar + 1) / 25.0);
            }
            QCOMPARE(value(line, "elements_before").toULongLong(), BarsUnderTest::expected(before, bar, bar).size());
            QCOMPARE(value(line, "elements_now").toULongLong(), BarsUnderTest::expected(now, bar, bar).size());
            QCOMPARE(value(line, "selected_now"), value(line, "elements_now"));
            QVERIFY(value(line, "min_now").isEmpty());
        }
        QCOMPARE(value(26, "part"), QStringLiteral("mesh"));
        QCOMPARE(value(26, "min_before").toDouble(), before.summary.min);
        QCOMPARE(value(26, "min_now").toDouble(), now.summary.min);
        QCOMPARE(value(26, "mean_now").toDouble(), now.summary.mean);
        QCOMPARE(value(26, "max_now").toDouble(), now.summary.max);
        QCOMPARE(value(26, "tangled_now").toInt(), now.summary.invalid);
        const QVector<GroupLine> groups = test.groups();
        for (int i = 0; i < groups.size(); ++i) {
            QCOMPARE(value(27 + i, "part"), QStringLiteral("group"));
            QCOMPARE(value(27 + i, "name"), groups[i].name);
            const QualitySummary sum = BarsUnderTest::summary_by_hand(now, groups[i].elements);
            QCOMPARE(value(27 + i, "elements_now").toULongLong(), groups[i].elements.size());
            QCOMPARE(value(27 + i, "min_now").toDouble(), sum.min);
            QVERIFY(std::abs(value(27 + i, "mean_now").toDouble() - sum.mean) < 1e-14);
            QCOMPARE(value(27 + i, "tangled_now").toInt(), sum.invalid);
        }
    }

    void names_of_groups_are_quoted() {
        QualityComparison comparison;
        comparison.groups.push_back({QStringLiteral("left, \"upper\"\nside"), {}, false, {}, {}});
        QVERIFY(comparison_csv(comparison).contains("group,\"left, \"\"upper\"\"\nside\",,"));
    }

    void drawings_are_written() {
        BarsUnderTest test;
        for (const bool is_overlay : {false, true}) {
            test.check("overlay_bars", is_overlay);
            const QSize size = is_overlay ? QSize(752, 316) : QSize(1016, 294);
            const QByteArray svg = test.exported(QStringLiteral("bars.svg"));
            QSvgRenderer renderer(svg);
            QVERIFY(renderer.isValid());
            QCOMPARE(renderer.viewBox().size(), size);
            QImage drawn(size, QImage::Format_RGB32);
            drawn.fill(Qt::magenta);
            QPainter painter(&drawn);
            renderer.render(&painter);
            painter.end();
            const QImage png = QImage::fromData(test.exported(QStringLiteral("bars.PNG")), "png");
            QCOMPARE(png.size(), size * 2);
            // Both show the same, on white, the alarm's colour where the tangled elements of now are.
            const QualityComparison shown = test.window->findChild<QualityPanel*>()->comparison();
            HistogramDrawing drawing = shown.now.drawing;
            drawing.frame = is_overlay ? QRectF(16, 16, 720, 240) : QRectF(520, 16, 480, 240);
            const QPoint foot = (QPointF(drawing.bar_area(-1).center().x(), drawing.plot().bottom() - 6)).toPoint();
            const Color alarm = tangled_color();
            for (const QColor& color : {drawn.pixelColor(foot), png.pixelColor(foot * 2)})
                QVERIFY2(std::abs(color.redF() - alarm[0]) < 0.02 && std::abs(color.blueF() - alarm[2]) < 0.02,
                         qPrintable(color.name()));
            for (const QColor& color : {drawn.pixelColor(2, 2), png.pixelColor(2, 2)})
                QCOMPARE(color, QColor(Qt::white));
        }
        QVERIFY(test.errors.isEmpty());
        // What was chosen, not what was typed, tells the kind where no end was typed.
        test.file_answer = test.folder.filePath(QStringLiteral("plain"));
        test.filter_answer = QStringLiteral("*.svg");
        test.click("export_histogram");
        QVERIFY(QSvgRenderer(test.folder.filePath(QStringLiteral("plain.svg"))).isValid());
        // Nor where the suggested name was left as it is; what is there already stays.
        for (const char* name : {"square-quality.svg", "square-quality-2.svg"}) {
            test.file_answer = test.folder.filePath(QStringLiteral("square-quality.csv"));
            test.click("export_histogram");
            QVERIFY2(QSvgRenderer(test.folder.filePath(QLatin1String(name))).isValid(), name);
        }
        QVERIFY(!QFile::exists(test.file_answer));
        QVERIFY(test.errors.isEmpty());
    }

    void what_cannot_be_written_is_told_in_one_sentence() {
        BarsUnderTest test;
        QVERIFY(QDir(test.folder.path()).mkdir(QStringLiteral("folder.csv")));
        const QString paths[] = {test.folder.filePath(QStringLiteral("folder.csv")),
                                 test.folder.filePath(QStringLiteral("nowhere/bars.svg")),
                                 QStringLiteral("/proc/nowhere/bars.png"),
                                 test.folder.filePath(QStringLiteral("bars.docx")),
                                 test.folder.filePath(QString(300, QLatin1Char('x')) + QStringLiteral(".csv"))};
        int number = 0;
        for (const QString& path : paths) {
            test.file_answer = path;
            test.click("export_histogram");
            QCOMPARE(test.errors.size(), ++number);
            QVERIFY2(test.errors.back().startsWith(path), qPrintable(test.errors.back()));
            QCOMPARE(test.errors.back().count(QLatin1Char('\n')), 0);
        }
        QCOMPARE(QDir(test.folder.path()).entryList(QDir::Files | QDir::Hidden),
                 QStringList(QStringLiteral("bends.json")));
        // Giving up is no error.
        test.file_answer.clear();
        test.click("export_histogram");
        QCOMPARE(test.errors.size(), number);
    }
};

QObject* make_test() {
    return new HistogramTest;
}

#include "histogram_test.moc"
