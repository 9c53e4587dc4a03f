#include "ui/document/sample_catalog.h"

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QRegularExpression>

namespace curvewright {
namespace {

constexpr qsizetype longest_text = 400;
constexpr qint64 largest_manifest = 1 << 20;

QString tr(const char* text) {
    return QCoreApplication::translate("Samples", text);
}

QString manifest_of(const QString& folder) {
    return QDir(folder).filePath(QStringLiteral("MANIFEST"));
}

/// Text for a label: one line, not endless.
QString text_of(const QJsonObject& object, const char* key) {
    return object.value(QLatin1String(key)).toString().simplified().left(longest_text);
}

/// A file of the folder; empty for one outside it.
QString path_of(const QJsonObject& object, const char* key, const QDir& folder) {
    const QString name = object.value(QLatin1String(key)).toString();
    const QString path = QDir::cleanPath(folder.absoluteFilePath(name));
    return !name.isEmpty() && path.startsWith(folder.absolutePath() + QLatin1Char('/')) ? path : QString();
}

/// Numbers of figures or tables, such as "2.10"; anything else is left out.
QStringList numbers_of(const QJsonObject& object, const char* key) {
    static const QRegularExpression number(QStringLiteral("\\A[0-9]{1,2}\\.[0-9]{1,2}\\z"));
    QStringList numbers;
    for (const QJsonValue value : object.value(QLatin1String(key)).toArray())
        if (numbers.size() < 9 && number.match(value.toString()).hasMatch()) numbers << value.toString();
    return numbers;
}

void read_method(const QJsonObject& object, Sample& sample) {
    const QString method = text_of(object, "method");
    for (const auto& [name, weighting] :
         {std::pair("convex", Weighting::convex), std::pair("affine", Weighting::affine),
          std::pair("elastic", Weighting::elastic)})
        if (method == QLatin1String(name)) sample.weighting = weighting;
    for (const auto& [name, untangling] : {std::pair("signed-angle", UntangleMethod::signed_angles),
                                           std::pair("unsigned-angle", UntangleMethod::unsigned_angles)})
        if (method == QLatin1String(name)) sample.method = untangling;
    sample.is_as_published = object.value(QLatin1String("as_published")).toBool();
    const double beta = object.value(QLatin1String("beta")).toDouble();
    if (beta > 0.0 && beta <= 1.0) sample.beta = beta;
    if (const QJsonValue minimum = object.value(QLatin1String("result_min")); minimum.isDouble())
        sample.result_minimum = minimum.toDouble();
}

std::optional<Sample> read_sample(const QJsonObject& object, const QDir& folder) {
    Sample sample;
    sample.name = text_of(object, "name");
    sample.title = text_of(object, "title");
    sample.description = text_of(object, "description");
    sample.look_for = text_of(object, "look_for");
    sample.mesh_path = path_of(object, "mesh", folder);
    sample.deformation_path = path_of(object, "deformation", folder);
    sample.thumbnail_path = path_of(object, "thumbnail", folder);
    const int chapter = object.value(QLatin1String("chapter")).toInt();
    if (chapter >= 2 && chapter <= 4) sample.chapter = chapter;
    sample.figures = numbers_of(object, "figures");
    sample.tables = numbers_of(object, "tables");
    sample.dimension = object.value(QLatin1String("dimension")).toInt(2);
    sample.order = object.value(QLatin1String("order")).toInt(1);
    sample.elements = object.value(QLatin1String("elements")).toInteger();
    sample.task = text_of(object, "task") == QLatin1String("untangle") ? Sample::Task::untangle : Sample::Task::warp;
    sample.is_deformed = text_of(object, "start") == QLatin1String("deformed");
    read_method(object, sample);
    const bool is_made_on_demand = object.value(QLatin1String("made_on_demand")).toBool();
    const bool is_known = !sample.mesh_path.isEmpty() && (is_made_on_demand || sample.is_there());
    if (sample.name.isEmpty() || !is_known) return std::nullopt;
    if (sample.title.isEmpty()) sample.title = sample.name;
    return sample;
}

}  // namespace

QString chapter_title(int chapter) {
    switch (chapter) {
        case 2:
            return tr("Chapter 2: warping");
        case 3:
            return tr("Chapter 3: unsigned angles");
        case 4:
            return tr("Chapter 4: signed angles");
        default:
            return tr("More samples");
    }
}

QString Sample::figures_text() const {
    if (figures.isEmpty()) return {};
    return (figures.size() == 1 ? tr("Figure %1") : tr("Figures %1")).arg(figures.join(QStringLiteral(", ")));
}

QString Sample::reference() const {
    QStringList parts;
    if (!figures.isEmpty()) parts << figures_text();
    if (!tables.isEmpty())
        parts << (tables.size() == 1 ? tr("Table %1") : tr("Tables %1")).arg(tables.join(QStringLiteral(", ")));
    return parts.join(QStringLiteral(" · "));
}

bool Sample::is_there() const {
    return QFile::exists(mesh_path);
}

QString Sample::how_to_make() const {
    return tr("This mesh is large and not kept with the program. Make it with “sample_meshes/generate.py %1” of the "
              "source code, which needs Gmsh’s Python module, so that it lies at %2; then open the sample again.")
        .arg(name, QDir::toNativeSeparators(mesh_path));
}

SampleCatalog SampleCatalog::load() {
    const QString program = QCoreApplication::applicationDirPath();
    QStringList folders;
    if (const QString chosen = qEnvironmentVariable("CURVEWRIGHT_SAMPLES"); !chosen.isEmpty()) folders << chosen;
    folders << program + QStringLiteral("/../../sample_meshes")
            << program + QStringLiteral("/../share/curvewright/sample_meshes")
            << QStringLiteral(CURVEWRIGHT_SOURCE_SAMPLES);
    for (const QString& folder : folders)
        if (QFile::exists(manifest_of(folder))) return load(QDir(folder).absolutePath());
    SampleCatalog none;
    none.error_ = tr("No sample meshes found: set CURVEWRIGHT_SAMPLES to the folder that holds their MANIFEST.");
    return none;
}

SampleCatalog SampleCatalog::load(const QString& folder) {
    SampleCatalog catalog;
    QFile file(manifest_of(folder));
    if (!file.open(QIODevice::ReadOnly) || file.size() > largest_manifest) {
        catalog.error_ = tr("%1: cannot be opened.").arg(file.fileName());
        return catalog;
    }
    QJsonParseError problem;
    const QJsonDocument json = QJsonDocument::fromJson(file.readAll(), &problem);
    if (problem.error != QJsonParseError::NoError || !json.object().value(QLatin1String("samples")).isArray()) {
        catalog.error_ =
            tr("%1: expected a JSON object with an array \"samples\"; %2.").arg(file.fileName(), problem.errorString());
        return catalog;
    }
    for (const QJsonValue value : json.object().value(QLatin1String("samples")).toArray())
        if (const auto sample = read_sample(value.toObject(), QDir(folder)); sample && !catalog.find(sample->name))
            catalog.samples_.push_back(*sample);
    return catalog;
}

QVector<int> SampleCatalog::chapters() const {
    QVector<int> chapters;
    for (const int chapter : {2, 3, 4, 0})
        if (!of_chapter(chapter).isEmpty()) chapters << chapter;
    return chapters;
}

QVector<Sample> SampleCatalog::of_chapter(int chapter) const {
    QVector<Sample> samples;
    for (const Sample& sample : samples_)
        if (sample.chapter == chapter) samples << sample;
    return samples;
}

const Sample* SampleCatalog::find(const QString& name) const {
    for (const Sample& sample : samples_)
        if (sample.name == name) return &sample;
    return nullptr;
}

}  // namespace curvewright
