/// What the colours show: chosen in the bar over the view, seen in the pixels, remembered, and kept in files.

#include <QComboBox>
#include <QLineEdit>
#include <QSettings>
#include <QToolButton>
#include <QTreeWidget>

#include "tests/gui/drag_under_test.h"
#include "tests/support/mesh_factory.h"
#include "ui/palette/quality_colors.h"
#include "ui/panels/clip_bar.h"
#include "ui/panels/color_bar.h"
#include "ui/panels/histogram_widget.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

double pressure(double x, double y) {
    return 100.0 + 8.0 * x + y;
}

/// A window with the square, whose file has a pressure and a velocity on the nodes and a material on the elements.
struct ColorsUnderTest : DragUnderTest {
    ColorsUnderTest() {
        const CurvedMesh mesh = square_mesh(4, 3);
        std::vector<FieldArray> fields(3);
        fields[0].name = "pressure";
        fields[1].name = "velocity";
        fields[1].components = 3;
        for (Eigen::Index i = 0; i < mesh.coordinates().rows(); ++i) {
            const double x = mesh.coordinates()(i, 0), y = mesh.coordinates()(i, 1);
            fields[0].values.push_back(pressure(x, y));
            fields[1].values.insert(fields[1].values.end(), {x - 0.5, 2.0, 0.0});
        }
        fields[2].name = "material";
        fields[2].place = FieldArray::Place::elements;
        for (Index element = 0; element < mesh.topology().element_count(); ++element)
            fields[2].values.push_back(static_cast<double>(element % 3));
        path = inputs.path(QStringLiteral("fields.vtu"));
        WriteOptions options;
        options.fields = &fields;
        write_mesh(path.toStdString(), mesh, options);
        open(path);
        window->action(CommandId::edges)->setChecked(false);
        QTest::qWait(50);
    }
    ~ColorsUnderTest() { window->document().mark_unchanged(); }

    /// Moves the bottom as a whole: the interior follows evenly.
    void drag_bottom(QPoint way) {
        EditSettings settings = window->edit().settings();
        settings.unit = GrabUnit::side;
        window->edit().set_settings(settings);
        drag_node(node_at(0.5, 0.0), way);
    }
    ColorBar& bar() { return *find<ColorBar>("color_bar"); }
    /// In the window.
    QRect place(const QWidget& widget) { return {widget.mapTo(window.get(), QPoint()), widget.size()}; }
    void show_bar() {
        view().setFocus();
        QTest::keyClick(&view(), Qt::Key_K);
        if (!QTest::qWaitFor([this] { return bar().isVisible(); })) qFatal("The bar did not come.");
    }
    /// Goes through a list with the arrow keys to the entry that begins so.
    void choose(const char* box, const char* beginning) {
        auto* list = find<QComboBox>(box);
        list->setFocus();
        const int wanted = list->findText(QLatin1String(beginning), Qt::MatchStartsWith);
        if (wanted < 0) qFatal("There is no %s.", beginning);
        for (int key = 0; key < 40 && list->currentIndex() != wanted; ++key)
            QTest::keyClick(list, list->currentIndex() < wanted ? Qt::Key_Down : Qt::Key_Up);
        if (list->currentIndex() != wanted) qFatal("%s cannot be chosen.", beginning);
        QTest::qWait(60);
    }
    void type(const char* field, const char* text) {
        auto* line = find<QLineEdit>(field);
        QTest::mouseClick(line, Qt::LeftButton);
        line->selectAll();
        if (*text == 0)
            QTest::keyClick(line, Qt::Key_Delete);
        else
            QTest::keyClicks(line, QLatin1String(text));
        QTest::keyClick(line, Qt::Key_Return);
        QTest::qWait(60);
    }
    Color seen(const Eigen::RowVector3d& point) { return seen_in(view(), point); }
    static Color seen_in(MeshView& view, const Eigen::RowVector3d& point) {
        const QColor color = view.picture(1).pixelColor(view.to_display(point).toPoint());
        return {color.redF(), color.greenF(), color.blueF()};
    }
    static bool is_close(const Color& a, const Color& b, double tolerance = 0.035) {
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(a[c] - b[c]) > tolerance) return false;
        return true;
    }
    Index element(double x, double y) {
        const auto found = view().element_at(view().to_display({x, y, 0.0}));
        if (!found) qFatal("There is no element there.");
        return *found;
    }

    QString path;
};

}  // namespace

class ColorsTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void arrays_come_along_with_a_session() {
        ColorsUnderTest test;
        test.drag_bottom({0, -12});
        test.file_answer = test.inputs.path(QStringLiteral("arrays.json"));
        test.window->action(CommandId::save_session)->trigger();
        WindowUnderTest other;
        other.file_answer = test.file_answer;
        other.window->action(CommandId::open_session)->trigger();
        QVERIFY(other.wait_for_job());
        QVERIFY(other.errors.isEmpty());
        const auto &was = *test.document().fields(), &is = *other.window->document().fields();
        QCOMPARE(is.size(), was.size());
        for (std::size_t i = 0; i < is.size(); ++i) {
            QCOMPARE(is[i].name, was[i].name);
            QVERIFY(is[i].values == was[i].values);
        }
        other.window->document().mark_unchanged();
    }

    void an_array_on_nodes_is_chosen_and_its_range_changed() {
        ColorsUnderTest test;
        test.show_bar();
        const auto* list = test.find<QComboBox>("color_quantity");
        for (const char* name : {"Scaled Jacobian", "Area", "Distance moved", "pressure (nodes)", "velocity (nodes)",
                                 "material (elements)"})
            QVERIFY2(list->findText(QLatin1String(name)) >= 0, name);
        test.choose("color_quantity", "pres");
        ColorScale scale{ColorMap::deep, false, 100.0, 109.0};
        QCOMPARE(test.view().shown_scale(), scale);
        const auto is_shown = [&] {
            for (const auto& [x, y] : {std::pair(0.1, 0.2), {0.45, 0.8}, {0.9, 0.55}})
                if (!ColorsUnderTest::is_close(test.seen({x, y, 0.0}), scale.color_of(pressure(x, y)))) return false;
            return true;
        };
        QVERIFY(is_shown());
        // The automatic range stands in the empty fields.
        QCOMPARE(test.find<QLineEdit>("color_lower")->text(), QString());
        QCOMPARE(test.find<QLineEdit>("color_lower")->placeholderText(), QStringLiteral("100"));
        test.type("color_upper", "104");
        scale.upper = 104.0;
        QCOMPARE(test.view().shown_scale(), scale);
        QVERIFY(is_shown());
        QVERIFY(ColorsUnderTest::is_close(test.seen({0.9, 0.55, 0.0}), map_color(ColorMap::deep, 1.0), 0.01));
        // An empty range is refused and says so; the picture stays.
        test.type("color_lower", "200");
        QVERIFY(test.find<QLineEdit>("color_lower")->property("wrong").toBool());
        QVERIFY(is_shown());
        test.type("color_lower", "");
        QVERIFY(!test.find<QLineEdit>("color_lower")->property("wrong").toBool());
        QTest::mouseClick(test.find<QToolButton>("color_reverse"), Qt::LeftButton);
        scale.is_reversed = true;
        QTest::qWait(60);
        QVERIFY(is_shown());
        test.choose("color_map", "grey");
        scale.map = ColorMap::grey;
        QVERIFY(is_shown());
        test.type("color_upper", "");
        scale.upper = 109.0;
        QVERIFY(is_shown());
    }

    void values_go_with_their_nodes_through_drag_and_undo() {
        ColorsUnderTest test;
        test.show_bar();
        test.choose("color_quantity", "pres");
        // A node inside, which follows the one that is dragged.
        const Index node = test.node_at(0.5, 1.0 / 12.0);
        const Eigen::RowVector3d start = test.positions().row(node);
        const Color expected = ColorScale{ColorMap::deep, false, 100.0, 109.0}.color_of(pressure(start.x(), start.y()));
        QVERIFY(ColorsUnderTest::is_close(test.seen(start), expected));
        test.drag_bottom({30, 20});
        const Eigen::RowVector3d moved = test.positions().row(node);
        QVERIFY((moved - start).norm() > 0.02);
        QVERIFY(ColorsUnderTest::is_close(test.seen(moved), expected));
        QVERIFY(!ColorsUnderTest::is_close(test.seen(start), expected, 0.01));
        test.click("tool_undo");
        QTest::qWait(60);
        QVERIFY(ColorsUnderTest::is_close(test.seen(start), expected));
    }

    void vectors_have_components_and_elements_one_colour() {
        ColorsUnderTest test;
        test.show_bar();
        QVERIFY(!test.find<QComboBox>("color_component")->isVisible());
        test.choose("color_quantity", "velo");
        QVERIFY(test.find<QComboBox>("color_component")->isVisible());
        QCOMPARE(test.view().shown_scale().lower, 2.0);
        test.choose("color_component", "x");
        QCOMPARE(test.view().shown_scale().lower, -0.5);
        QVERIFY(ColorsUnderTest::is_close(test.seen({0.8, 0.3, 0.0}), test.view().shown_scale().color_of(0.3)));
        test.choose("color_quantity", "mate");
        QVERIFY(!test.find<QComboBox>("color_component")->isVisible());
        for (const auto& [x, y] : {std::pair(0.1, 0.2), {0.4, 0.7}, {0.9, 0.55}}) {
            const double value = static_cast<double>(test.element(x, y) % 3);
            QVERIFY(ColorsUnderTest::is_close(test.seen({x, y, 0.0}), map_color(ColorMap::deep, value / 2.0), 0.01));
        }
    }

    void distances_follow_the_hand_and_the_history() {
        ColorsUnderTest test;
        test.show_bar();
        test.choose("color_quantity", "dist");
        const Color still = map_color(ColorMap::warm, 1.0);
        QVERIFY(ColorsUnderTest::is_close(test.seen({0.5, 0.06, 0.0}), still, 0.01));
        const Index node = test.node_at(0.5, 0.0), inside = test.node_at(0.5, 1.0 / 12.0);
        const Eigen::RowVector3d start = test.positions().row(inside);
        test.take(node);
        test.move_by({0, -30});
        const double upper = test.view().shown_scale().upper;
        QVERIFY(upper < 0.3 && upper > 0.01);  // of what moves in hand
        test.move_by({0, -15});
        QVERIFY(test.view().shown_scale().upper > upper);
        test.let_go();
        const Eigen::RowVector3d moved = test.positions().row(node);
        QCOMPARE(test.view().shown_scale().upper, moved.y());
        const Eigen::RowVector3d followed = test.positions().row(inside);
        QVERIFY((followed - start).norm() > 0.02);
        QVERIFY(ColorsUnderTest::is_close(
            test.seen(followed), map_color(ColorMap::warm, 1.0 - (followed - start).norm() / moved.y()), 0.05));
        test.click("tool_undo");
        QTest::qWait(60);
        QVERIFY(ColorsUnderTest::is_close(test.seen({0.5, 0.06, 0.0}), still, 0.01));
        test.click("tool_redo");
        QTest::qWait(60);
        QCOMPARE(test.view().shown_scale().upper, moved.y());
    }

    void computed_numbers_follow_the_history() {
        ColorsUnderTest test;
        test.show_bar();
        test.choose("color_quantity", "area");
        const double part = 1.0 / 32.0;
        const auto has_upper = [&](auto is_right) {
            return QTest::qWaitFor([&] { return is_right(test.view().shown_scale().upper); });
        };
        // All alike: the range is widened about the one value.
        QVERIFY(has_upper([&](double upper) { return std::abs(upper - 1.1 * part) < 1e-9; }));
        test.drag_bottom({0, 60});
        QVERIFY(has_upper([&](double upper) { return upper > 1.12 * part && upper < 3.0 * part; }));
        test.click("tool_undo");
        QVERIFY(has_upper([&](double upper) { return std::abs(upper - 1.1 * part) < 1e-9; }));
        test.choose("color_quantity", "shape");
        QVERIFY(QTest::qWaitFor([&] {
            return ColorsUnderTest::is_close(test.seen({0.4, 0.4, 0.0}), map_color(ColorMap::warm, 1.0), 0.01);
        }));
        // Stretching the mesh by a little costs a little of the shape.
        test.type("color_lower", "0.98");
        test.click("tool_redo");
        QVERIFY(QTest::qWaitFor([&] {
            return !ColorsUnderTest::is_close(test.seen({0.4, 0.4, 0.0}), map_color(ColorMap::warm, 1.0), 0.05);
        }));
    }

    void the_scaled_jacobian_has_one_scale_everywhere() {
        ColorsUnderTest test;
        test.drag_node(test.node_at(0.5, 0.0), {10, 10});
        const QualityReport& report = *test.document().state().quality;
        const Index worst = report.worst(1).front();
        const double value = report.elements[static_cast<std::size_t>(worst)].scaled_jacobian;
        QVERIFY(value > 0.05 && value < 0.95);
        const auto swatch = [&] {
            const QColor color = test.find<QTreeWidget>("worst_elements")
                                     ->topLevelItem(0)
                                     ->icon(0)
                                     .pixmap(16, 16)
                                     .toImage()
                                     .pixelColor(8, 8);
            return Color{color.redF(), color.greenF(), color.blueF()};
        };
        const auto bar_color = [&] {
            // The bar of the best elements, the last one.
            auto* histogram = test.find<HistogramWidget>("after_histogram");
            const QImage image = histogram->grab().toImage();
            const QColor color = image.pixelColor(image.width() - 14, image.height() - 30);
            return Color{color.redF(), color.greenF(), color.blueF()};
        };
        QVERIFY(ColorsUnderTest::is_close(swatch(), quality_map(value), 0.01));
        QVERIFY(ColorsUnderTest::is_close(bar_color(), quality_map(0.98), 0.01));
        test.show_bar();
        test.choose("color_map", "grey");
        test.type("color_lower", "-1");
        const ColorScale scale{ColorMap::grey, false, -1.0, 1.0};
        QVERIFY(ColorsUnderTest::is_close(swatch(), scale.color_of(value), 0.01));
        QVERIFY(ColorsUnderTest::is_close(bar_color(), scale.color_of(0.98), 0.01));
        const Eigen::RowVector3d center = test.document().state().mesh->element_center(worst);
        QVERIFY(ColorsUnderTest::is_close(test.seen(center), scale.color_of(value), 0.01));
        // Also while the view shows something else.
        test.choose("color_quantity", "pres");
        QVERIFY(ColorsUnderTest::is_close(swatch(), scale.color_of(value), 0.01));
    }

    void choices_are_remembered() {
        {
            ColorsUnderTest test;
            test.show_bar();
            test.choose("color_quantity", "velo");
            test.choose("color_component", "y");
            test.choose("color_map", "bal");
            test.type("color_lower", "-3");
            test.choose("color_quantity", "pres");
            test.type("color_upper", "103.5");
        }
        ColorsUnderTest test;
        QCOMPARE(test.view().shown_scale(), (ColorScale{ColorMap::deep, false, 100.0, 103.5}));
        test.show_bar();
        test.choose("color_quantity", "velo");
        QCOMPARE(test.find<QComboBox>("color_component")->currentText(), QStringLiteral("y"));
        QCOMPARE(test.view().shown_scale().map, ColorMap::balance);
        QCOMPARE(test.view().shown_scale().lower, -3.0);
        // A file without that array shows the scaled Jacobian, and with it the array again.
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        QCOMPARE(test.find<QComboBox>("color_quantity")->currentText(), QStringLiteral("Scaled Jacobian"));
        QCOMPARE(test.view().shown_scale(), ColorScale());
        test.open(test.path);
        QCOMPARE(test.find<QComboBox>("color_quantity")->currentText(), QStringLiteral("velocity (nodes)"));
    }

    void the_legend_opens_the_bar_and_bars_stack() {
        ColorsUnderTest test;
        QVERIFY(!test.bar().isVisible());
        const QPoint legend(test.view().width() - 60, test.view().height() / 2);
        QTest::mouseClick(&test.view(), Qt::LeftButton, {}, legend);
        QVERIFY(QTest::qWaitFor([&] { return test.bar().isVisible(); }));
        QTest::mouseClick(test.find<QToolButton>("color_close"), Qt::LeftButton);
        QVERIFY(!test.bar().isVisible());
        QTest::mouseClick(&test.view(), Qt::LeftButton, {}, legend);
        QVERIFY(test.bar().isVisible());
        // Beside a legend that is not shown, a click is one on the mesh's ground.
        test.window->action(CommandId::legend)->trigger();
        QTest::qWait(60);
        QTest::mouseClick(&test.view(), Qt::LeftButton, {}, legend);
        QVERIFY(test.bar().isVisible());
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        test.window->action(CommandId::clip)->trigger();
        test.window->action(CommandId::compare)->trigger();
        QTest::qWait(60);
        auto* clip = test.find<ClipBar>("clip_bar");
        QVERIFY(clip->isVisible());
        QVERIFY(!clip->geometry().intersects(test.bar().geometry()));
        for (QWidget* name : test.window->findChildren<QWidget*>(QStringLiteral("view_name"))) {
            QVERIFY(!test.place(*name).intersects(test.place(*clip)));
            QVERIFY(!test.place(*name).intersects(test.place(test.bar())));
        }
        test.window->action(CommandId::clip)->trigger();
        QVERIFY(!clip->isVisible() && test.bar().y() < 60);
    }

    void bars_leave_the_legend_free() {
        ColorsUnderTest test;
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        test.window->resize(1280, 800);
        test.show_bar();
        test.window->action(CommandId::clip)->trigger();
        auto* clip = test.find<QWidget>("clip_bar");
        auto* field = test.find<QWidget>("color_lower");
        for (const bool is_split : {false, true, false}) {
            field->setFocus();
            test.window->action(CommandId::compare)->setChecked(is_split);
            QTest::qWait(60);
            // Where the legend stands, which is the last view's alone.
            const QRect view = test.place(test.view());
            const QRect legend = view.adjusted(test.view().free_area().toRect().width(), 0, 0, 0);
            QVERIFY(legend.width() > 80 && legend.width() < 200);
            for (const QWidget* bar : {clip, static_cast<QWidget*>(&test.bar())}) {
                QVERIFY(bar->isVisible());
                QVERIFY(!test.place(*bar).intersects(legend));
                QVERIFY(bar->parentWidget()->rect().contains(bar->geometry()));
            }
            QVERIFY(!clip->geometry().intersects(test.bar().geometry()));
            QCOMPARE(test.window->focusWidget(), field);
        }
    }

    void both_views_have_one_scale() {
        ColorsUnderTest test;
        test.show_bar();
        test.drag_node(test.node_at(0.5, 0.0), {0, 60});
        test.window->action(CommandId::compare)->trigger();
        QTest::qWait(60);
        MeshView& before = *test.find<MeshView>("before_view");
        for (const char* quantity : {"dist", "area", "pres", "scal"}) {
            test.choose("color_quantity", quantity);
            QVERIFY2(QTest::qWaitFor([&] { return before.shown_scale() == test.view().shown_scale(); }), quantity);
        }
        test.choose("color_quantity", "dist");
        QVERIFY(ColorsUnderTest::is_close(ColorsUnderTest::seen_in(before, {0.5, 0.06, 0.0}),
                                          map_color(ColorMap::warm, 1.0), 0.01));
        test.choose("color_quantity", "pres");
        QVERIFY(ColorsUnderTest::is_close(ColorsUnderTest::seen_in(before, {0.3, 0.6, 0.0}),
                                          test.view().shown_scale().color_of(pressure(0.3, 0.6))));
    }

    void arrays_are_kept_in_files() {
        ColorsUnderTest test;
        test.drag_node(test.node_at(0.5, 0.0), {0, 40});
        for (const char* name : {"out.vtu", "out.msh", "out.vtk"}) {
            test.file_answer = test.inputs.path(QLatin1String(name));
            test.window->action(CommandId::export_mesh)->trigger();
            QVERIFY(test.wait_for_job());
            const ReadResult back = read_mesh(test.file_answer.toStdString());
            int found = 0;
            for (const FieldArray& field : back.fields)
                for (const FieldArray& kept : *test.document().fields())
                    if (field.name == kept.name && field.place == kept.place) {
                        ++found;
                        QCOMPARE(field.components, kept.components);
                        QCOMPARE(field.values, kept.values);
                    }
            QCOMPARE(found, 3);
        }
        QVERIFY(test.errors.isEmpty());
    }
};

QObject* make_test() {
    return new ColorsTest;
}

#include "colors_test.moc"
