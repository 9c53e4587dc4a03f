#pragma once

#include <set>
#include <string>
#include <vector>

#include "benchmarks/tables/report.h"
#include "benchmarks/thesis/settings.h"

namespace curvewright::benchmarks {

class ThesisReport;

/// Whose numbers a row shows.
enum class By {
    thesis,   ///< what is printed there
    here,     ///< the same quantity of the remade example, before any method
    literal,  ///< the thesis's method, by this program
    best,     ///< what this program has beyond the thesis
    peer,     ///< other programs on the same file
};
const char* to_string(By by);

/// Why a row has no numbers.
enum class NotRun {
    quick,    ///< left out by --quick
    missing,  ///< its mesh is not there
};

/// One table of the thesis and what stands against it: a row per thing (level, example, mesh) and method.
class Comparison {
  public:
    /// what: heading of the first column. columns: headings of the numbers.
    Comparison(TableId id, std::string title, std::string note, std::string what, std::vector<std::string> columns);

    /// values: one per column; missing ones at the end are empty. Rows of the same thing stand together, in the order
    /// in which the things come first.
    void add(By by, const std::string& what, const std::string& method, std::vector<Cell> values,
             const std::string& remark = "");
    /// A thing of which the thesis shows no numbers, such as a point of a plot.
    void expect(const std::string& what) { expected_.insert(what); }
    /// Says in the table why a thing was not run. explanation: for a missing mesh, how to make it.
    void leave_out(const std::string& what, NotRun why, const std::string& explanation = "");

    const TableId& id() const { return id_; }
    Table table() const;
    /// Whether everything that the thesis shows was run.
    bool is_complete() const;
    bool lacks_meshes() const { return lacks_meshes_; }

  private:
    TableId id_;
    Table table_;
    std::set<std::string> expected_, measured_;
    bool lacks_meshes_ = false;
};

/// Counts how often something holds.
class Tally {
  public:
    void add(bool holds, const std::string& name);
    bool is_empty() const { return all_ == 0; }
    /// "8 of 9; not shell2"
    Target target(const std::string& what, const std::string& promised) const;
    /// The same among the targets of a report. Nothing is said of a tally of nothing.
    void tell_in(ThesisReport& report, const std::string& what, const std::string& promised) const;

  private:
    int held_ = 0, all_ = 0;
    std::string others_;
};

/// Three digits after the point.
Cell fixed(double number);

}  // namespace curvewright::benchmarks
