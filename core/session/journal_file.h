#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/session/action.h"

namespace curvewright {

// A journal is a file that grows by one record for everything that happens to a document, so that all of its history
// can be had again after a crash. Every record has checksums: a file that breaks off in the middle of one is good up to
// the record before. Numbers are those of the machine that wrote them.
//
//   file    "CWJRNL1\n", 8 bytes that tell the byte order, records
//   record  32 bytes: kind, size of the text, size of the data, checksums of both, number, checksum of these 28 bytes;
//           text: one JSON object; data
//   head    data: the positions as opened, nodes × 3 doubles
//   step    data: the action (JSON), then what moved: count, node indices (32 bits), 3 doubles each

/// What a journal begins with.
struct JournalHead {
    std::string mesh;            ///< file that was opened
    std::string saved;           ///< file that the document stands for: another one after it was saved
    int clean = 0;               ///< steps done in the state that need not be saved; -1 = there is none
    std::uint64_t topology = 0;  ///< fingerprint() of the mesh as opened
};

/// What a journal knows of a step besides the positions.
struct JournalStep {
    std::string name, details;
    Action action;
    std::vector<std::string> applied_deformations;  ///< files, on the way from the opened mesh to here
};

/// Differs for meshes that differ in node tags, elements or connectivity.
std::uint64_t fingerprint(const MeshTopology& topology);

// Records. number: 0 for the head, 1 more for every following one.

/// The first record: what was opened, and its positions.
std::string journal_head(const JournalHead& head, const Coordinates& opened);
/// A step that was done when `at` steps were done; what had been undone is gone. Positions are told as those that
/// differ from before, bit by bit.
std::string journal_step(std::uint32_t number, int at, const JournalStep& step, const Coordinates& before,
                         const Coordinates& after);
/// Undo, redo or a jump: so many steps are done now.
std::string journal_jump(std::uint32_t number, int index);
/// The state that need not be saved, and the file that the document stands for.
std::string journal_clean(std::uint32_t number, int clean, const std::string& saved);
/// A deformation was loaded.
std::string journal_deformation(std::uint32_t number, const std::string& file);

/// What a journal tells of itself without its positions.
struct JournalSummary {
    std::string mesh, saved;
    std::vector<std::string> steps;  ///< names of those that are done
    int index = 0, clean = 0;
    std::int64_t time = 0;  ///< of the last record, milliseconds since 1970
    bool is_dirty() const { return index != clean; }
};

/// All of a journal.
struct JournalContent {
    /// A step with the state that it leads to.
    struct Step : JournalStep {
        Coordinates positions;  ///< after it
    };
    JournalHead head;
    Coordinates opened;
    std::vector<Step> steps;      ///< those done, and those that can be redone
    int index = 0;                ///< steps done
    std::vector<Action> session;  ///< everything that was done, from opening on
    std::string deformation;      ///< file loaded last; "" = none
    std::uint64_t intact_bytes = 0;
    std::uint32_t records = 0;  ///< in the intact bytes
    std::string damage;         ///< a sentence about what cannot be read after intact_bytes; "" = all of it can be
};

/// Fast: passes over the positions and does not check them. What comes after damage is left out. Throws InvalidInput
/// that names the file if it is no journal, or not even its head can be read.
JournalSummary summarize_journal(const std::filesystem::path& file);
/// Everything up to the first damage. Throws InvalidInput like summarize_journal, and Cancelled.
JournalContent read_journal(const std::filesystem::path& file, const TaskContext& context = {});

/// A journal that is being written. Not for several threads at once.
class JournalFile {
  public:
    /// Begins a new file, or goes on with one of which so many bytes are kept.
    explicit JournalFile(std::filesystem::path file, std::uint64_t kept_bytes = 0);
    ~JournalFile();
    JournalFile(const JournalFile&) = delete;
    JournalFile& operator=(const JournalFile&) = delete;

    /// Writes a record, after those that could not be written before. False if that fails (the disk is full): nothing
    /// half-written stays, and the next call tries again.
    bool append(std::string record);

  private:
    bool open();
    bool write(const std::string& bytes);

    std::filesystem::path file_;
    int handle_ = -1;
    std::uint64_t size_ = 0;  ///< of what is whole
    std::vector<std::string> waiting_;
};

}  // namespace curvewright
