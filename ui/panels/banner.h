#pragma once

#include <vector>

#include <QWidget>

#include "ui/document/notice_board.h"
#include "ui/panels/theme.h"

class QPushButton;

namespace curvewright {

/// What is to be read, in lines over the view that stay until they are dismissed: each with its kind, its text, which
/// wraps, and buttons that do something about it. Takes nobody's keyboard; Tab and F6 lead into it.
class Banner : public QWidget {
    Q_OBJECT

  public:
    explicit Banner(const Theme& theme, QWidget* parent = nullptr);
    ~Banner() override;

    /// Shows these, the first few of them until somebody asks for the others; hides the banner if there are none.
    void show_lines(const std::vector<NoticeBoard::Line>& lines);
    /// What is shown, a line each.
    QString text() const;

  signals:
    /// A button of a notice: its place among NoticeBoard::Line::notice.actions.
    void action_triggered(int id, int action);
    void dismissed(int id);

  private:
    class Row;

    void fill();

    const Theme& theme_;
    std::vector<NoticeBoard::Line> lines_;
    std::vector<Row*> rows_;  ///< made when needed, and used again
    QPushButton* more_ = nullptr;
};

}  // namespace curvewright
