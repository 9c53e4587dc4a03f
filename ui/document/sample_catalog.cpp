#include "ui/document/sample_catalog.h"

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("Samples", text);
}

QString manifest_of(const QString& folder) {
    return QDir(folder).filePath(QStringLiteral("MANIFEST"));
}

}  // namespace

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
    if (!file.open(QIODevice::ReadOnly)) {
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
    const QDir base(folder);
    for (const QJsonValue value : json.object().value(QLatin1String("samples")).toArray()) {
        const QJsonObject object = value.toObject();
        const auto text = [&](const char* key) { return object.value(QLatin1String(key)).toString(); };
        const auto path = [&](const char* key) {
            return text(key).isEmpty() ? QString() : QDir::cleanPath(base.absoluteFilePath(text(key)));
        };
        Sample sample;
        sample.name = text("name");
        sample.title = text("title");
        sample.description = text("description");
        sample.mesh_path = path("mesh");
        sample.deformation_path = path("deformation");
        sample.thumbnail_path = path("thumbnail");
        sample.dimension = object.value(QLatin1String("dimension")).toInt(2);
        sample.order = object.value(QLatin1String("order")).toInt(1);
        sample.elements = object.value(QLatin1String("elements")).toInteger();
        sample.task = text("task") == QLatin1String("untangle") ? Sample::Task::untangle : Sample::Task::warp;
        sample.is_deformed = text("start") == QLatin1String("deformed");
        if (const QJsonValue beta = object.value(QLatin1String("beta")); beta.isDouble()) sample.beta = beta.toDouble();
        if (!sample.name.isEmpty() && QFile::exists(sample.mesh_path)) catalog.samples_.push_back(sample);
    }
    return catalog;
}

const Sample* SampleCatalog::find(const QString& name) const {
    for (const Sample& sample : samples_)
        if (sample.name == name) return &sample;
    return nullptr;
}

}  // namespace curvewright
