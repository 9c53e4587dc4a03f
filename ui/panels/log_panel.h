#pragma once

#include <QWidget>

#include "ui/document/message_log.h"
#include "ui/panels/theme.h"

class QLabel;
class QPushButton;
class QTableWidget;

namespace curvewright {

/// Everything that was told in this session, the newest last: when, about which step, and what.
class LogPanel : public QWidget {
    Q_OBJECT

  public:
    LogPanel(MessageLog& log, const Theme& theme, QWidget* parent = nullptr);

  signals:
    /// Somebody wants to see what an entry speaks of: what of it there is.
    void entry_chosen(const LogEntry& entry);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    void add_row();
    void fill_row(int row);
    void fit_rows();
    void choose(int row);
    void copy();
    void refresh();

    MessageLog& log_;
    const Theme& theme_;
    QTableWidget* table_ = nullptr;
    QPushButton *copy_ = nullptr, *clear_ = nullptr;
    QLabel* empty_ = nullptr;
};

}  // namespace curvewright
