#pragma once

#include <QWidget>

#include "ui/document/recent_files.h"
#include "ui/document/sample_catalog.h"
#include "ui/panels/theme.h"

class QLabel;
class QVBoxLayout;

namespace curvewright {

/// What the window shows before a mesh is open: where to drop one, the recent files, the samples.
class StartPage : public QWidget {
    Q_OBJECT

  public:
    StartPage(const SampleCatalog& samples, RecentFiles& recent, const Theme& theme, QWidget* parent = nullptr);

    /// Lights up the drop zone while a file hovers over the window.
    void set_drop_active(bool is_active);

  signals:
    void open_requested();
    void file_chosen(const QString& path);
    void sample_chosen(const Sample& sample);

  private:
    QWidget* make_drop_zone();
    QWidget* make_gallery(const QVector<Sample>& samples);
    void show_recent();

    RecentFiles& recent_;
    const Theme& theme_;
    QWidget* drop_zone_ = nullptr;
    QWidget* recent_section_ = nullptr;
    QVBoxLayout* recent_list_ = nullptr;
};

}  // namespace curvewright
