#pragma once

#include <vector>

#include <QString>
#include <QWidget>

#include "core/timeline/explanation.h"
#include "ui/panels/theme.h"

namespace curvewright {

/// The course of an iteration on one patch: what is minimised and what else counts, step by step. A click goes there.
class ConvergencePlot : public QWidget {
    Q_OBJECT

  public:
    explicit ConvergencePlot(const Theme& theme, QWidget* parent = nullptr);

    void clear();
    /// The step shown is marked.
    void show_course(const StepExplanation& step);

    QSize sizeHint() const override { return {240, 100}; }
    QSize minimumSizeHint() const override { return {160, 100}; }
    /// Where a step of the course is drawn, in the widget's pixels; −1 = it is not in the course.
    double x_of(StepNumber step) const;

  signals:
    void step_chosen(StepNumber step);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    bool event(QEvent* event) override;

  private:
    struct Series {
        QString name;
        bool is_second = false;      ///< thinner and dashed
        std::vector<double> values;  ///< one per point of the course
    };
    QRectF plot() const;
    std::size_t point_at(double x) const;
    void choose(double x);

    const Theme& theme_;
    std::vector<ConvergencePoint> course_;
    std::vector<Series> series_;
    std::size_t now_ = 0;
    bool is_logarithmic_ = false;
    double lower_ = 0.0, upper_ = 1.0;
};

}  // namespace curvewright
