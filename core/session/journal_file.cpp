#include "core/session/journal_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_depth.h"
#include "core/session/session_file.h"

namespace curvewright {
namespace {

using Json = nlohmann::ordered_json;

constexpr char magic[8] = {'C', 'W', 'J', 'R', 'N', 'L', '1', '\n'};
constexpr std::uint64_t byte_order = 0x0102030405060708;
constexpr std::uint64_t start_size = sizeof magic + sizeof byte_order;

enum class Kind : std::uint32_t { head = 1, step = 2, jump = 3, clean = 4, deformation = 5 };

struct RecordHeader {
    std::uint32_t kind = 0, text_size = 0;
    std::uint64_t data_size = 0;
    std::uint32_t text_check = 0, data_check = 0, number = 0, check = 0;
};
static_assert(sizeof(RecordHeader) == 32);
static_assert(sizeof(Index) == 4);

std::uint32_t checksum(const void* bytes, std::size_t size) {
    return static_cast<std::uint32_t>(crc32_z(0, static_cast<const Bytef*>(bytes), size));
}

std::uint32_t own_checksum(const RecordHeader& header) {
    return checksum(&header, offsetof(RecordHeader, check));
}

std::string make_record(Kind kind, std::uint32_t number, Json text, const std::string& data) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    text["time"] = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
    const std::string line = text.dump(-1, ' ', false, Json::error_handler_t::replace);
    RecordHeader header;
    header.kind = static_cast<std::uint32_t>(kind);
    header.text_size = static_cast<std::uint32_t>(line.size());
    header.data_size = data.size();
    header.text_check = checksum(line.data(), line.size());
    header.data_check = checksum(data.data(), data.size());
    header.number = number;
    header.check = own_checksum(header);
    std::string record;
    record.reserve(sizeof header + line.size() + data.size());
    record.append(reinterpret_cast<const char*>(&header), sizeof header);
    return record.append(line).append(data);
}

template <class Value>
void put(std::string& data, const Value& value) {
    data.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Takes pieces off the front of a record's data. Throws a sentence's rest when there is too little.
class Pieces {
  public:
    explicit Pieces(std::string_view data) : data_(data) {}
    std::string_view take(std::uint64_t size) {
        if (size > data_.size()) throw InvalidInput("a record is shorter than it says.");
        const std::string_view piece = data_.substr(0, size);
        data_.remove_prefix(size);
        return piece;
    }
    std::uint64_t take_number() {
        std::uint64_t number = 0;
        std::memcpy(&number, take(sizeof number).data(), sizeof number);
        return number;
    }
    bool is_empty() const { return data_.empty(); }
    std::uint64_t size() const { return data_.size(); }

  private:
    std::string_view data_;
};

/// Writes the rows of a step over those before it.
void move_nodes(Pieces& pieces, Coordinates& x) {
    const std::uint64_t count = pieces.take_number();
    constexpr std::uint64_t bytes_per_node = sizeof(Index) + 3 * sizeof(double);
    if (count > pieces.size() / bytes_per_node || count * bytes_per_node != pieces.size())
        throw InvalidInput("a step has another number of nodes than it says.");
    const std::string_view nodes = pieces.take(count * sizeof(Index)), rows = pieces.take(count * 3 * sizeof(double));
    Index last = -1;
    for (std::uint64_t i = 0; i < count; ++i) {
        Index node = 0;
        std::memcpy(&node, nodes.data() + i * sizeof node, sizeof node);
        if (node <= last || node >= x.rows()) throw InvalidInput("a step moves nodes that the mesh does not have.");
        last = node;
        std::memcpy(x.data() + 3 * static_cast<std::ptrdiff_t>(node), rows.data() + i * 3 * sizeof(double),
                    3 * sizeof(double));
        if (!x.row(node).allFinite()) throw InvalidInput("a step has positions that are not finite.");
    }
}

/// Goes through a journal record by record.
class Scanner {
  public:
    /// Throws InvalidInput if the file is no journal.
    explicit Scanner(const std::filesystem::path& file) : file_(file), stream_(file, std::ios::binary | std::ios::ate) {
        if (!stream_) throw fail("the kept work cannot be read.");
        size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream_.tellg()));
        stream_.seekg(0);
        char start[sizeof magic] = {};
        std::uint64_t order = 0;
        stream_.read(start, sizeof start);
        stream_.read(reinterpret_cast<char*>(&order), sizeof order);
        if (!stream_ || std::memcmp(start, magic, sizeof magic) != 0) throw fail("this is no kept work.");
        if (order != byte_order) throw fail("this work was kept by another kind of machine.");
        at_ = start_size;
    }

    InvalidInput fail(const std::string& what) const { return {file_.string(), 0, what}; }
    std::uint64_t size() const { return size_; }
    std::uint64_t position() const { return at_; }
    bool is_at_end() const { return at_ == size_; }

    /// The next record. Throws InvalidInput (a sentence without the file) if it is damaged.
    void read(bool with_data) {
        if (size_ - at_ < sizeof header_) throw InvalidInput("the last record breaks off.");
        stream_.clear();
        stream_.seekg(static_cast<std::streamoff>(at_));
        stream_.read(reinterpret_cast<char*>(&header_), sizeof header_);
        if (!stream_) throw InvalidInput("a record cannot be read.");
        if (header_.check != own_checksum(header_) || header_.number != number_)
            throw InvalidInput("a record is damaged.");
        const std::uint64_t left = size_ - at_ - sizeof header_;
        if (header_.text_size > left || header_.data_size > left - header_.text_size)
            throw InvalidInput("the last record breaks off.");
        const std::string text = take(header_.text_size, header_.text_check);
        if (with_data) data_ = take(header_.data_size, header_.data_check);
        if (is_json_too_deep(text)) throw InvalidInput("a record is damaged.");
        json_ = Json::parse(text, nullptr, false);
        if (!json_.is_object()) throw InvalidInput("a record is damaged.");
    }
    /// The record that was read is as it should be.
    void accept() {
        at_ += sizeof header_ + header_.text_size + header_.data_size;
        ++number_;
    }

    Kind kind() const { return static_cast<Kind>(header_.kind); }
    std::uint64_t data_size() const { return header_.data_size; }
    const std::string& data() const { return data_; }
    std::string text(const char* key) const { return text_of(member(key)); }
    std::vector<std::string> texts(const char* key) const {
        const Json& list = member(key);
        if (!list.is_array()) throw InvalidInput("a record is damaged.");
        std::vector<std::string> result;
        for (const Json& value : list) result.push_back(text_of(value));
        return result;
    }
    std::int64_t number(const char* key) const {
        const Json& value = member(key);
        if (!value.is_number_integer()) throw InvalidInput("a record is damaged.");
        return value.get<std::int64_t>();
    }

  private:
    static std::string text_of(const Json& value) {
        if (!value.is_string()) throw InvalidInput("a record is damaged.");
        return value.get<std::string>();
    }
    const Json& member(const char* key) const {
        const auto found = json_.find(key);
        if (found == json_.end()) throw InvalidInput("a record is damaged.");
        return *found;
    }
    std::string take(std::uint64_t size, std::uint32_t check) {
        std::string bytes(size, '\0');
        stream_.read(bytes.data(), static_cast<std::streamsize>(size));
        if (!stream_ || checksum(bytes.data(), bytes.size()) != check) throw InvalidInput("a record is damaged.");
        return bytes;
    }

    std::filesystem::path file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0, at_ = 0;
    std::uint32_t number_ = 0;
    RecordHeader header_;
    std::string data_;
    Json json_;
};

/// Where the history stands, told by the records.
struct Standing {
    int count = 0, index = 0, clean = 0;

    void step(std::int64_t at) {
        if (at < 0 || at > count || at != index) throw InvalidInput("a step begins where the history does not stand.");
        // What had been undone is gone, and with it a saved state among it.
        if (clean > index) clean = -1;
        count = ++index;
    }
    void jump(std::int64_t to) {
        if (to < 0 || to > count) throw InvalidInput("the history goes to a step that it does not have.");
        index = static_cast<int>(to);
    }
    void set_clean(std::int64_t at) {
        if (at < -1 || at > count) throw InvalidInput("a state was saved that the history does not have.");
        clean = static_cast<int>(at);
    }
};

JournalHead read_head(Scanner& scanner, bool with_data) {
    try {
        scanner.read(with_data);
        if (scanner.kind() != Kind::head) throw InvalidInput("the first record is no head.");
        JournalHead head{scanner.text("mesh"), scanner.text("saved"), static_cast<int>(scanner.number("clean")),
                         std::stoull("0" + scanner.text("topology"), nullptr, 16)};
        const std::int64_t nodes = scanner.number("nodes");
        if (nodes < 0 || nodes > 0x7fffffff || scanner.data_size() != 24 * static_cast<std::uint64_t>(nodes) ||
            head.mesh.empty() || head.clean < -1 || head.clean > 0)
            throw InvalidInput("the head is damaged.");
        scanner.accept();
        return head;
    } catch (const std::exception&) {
        throw scanner.fail("the kept work is damaged at its beginning; nothing of it can be recovered.");
    }
}

}  // namespace

std::uint64_t fingerprint(const MeshTopology& topology) {
    std::uint64_t hash = 0xcbf29ce484222325;
    const auto add = [&hash](std::uint64_t value) {
        hash = (hash ^ value) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 29;
    };
    add(static_cast<std::uint64_t>(topology.node_count()));
    for (Index node = 0; node < topology.node_count(); ++node)
        add(static_cast<std::uint64_t>(topology.node_tag(node).value));
    for (const ElementBlock& block : topology.blocks()) {
        add(static_cast<std::uint64_t>(block.type.shape));
        add(static_cast<std::uint64_t>(block.type.order));
        add(block.tags.size());
        for (const ElementTag tag : block.tags) add(static_cast<std::uint64_t>(tag.value));
        for (const Index node : block.nodes) add(static_cast<std::uint64_t>(node));
    }
    return hash;
}

std::string journal_head(const JournalHead& head, const Coordinates& opened) {
    const std::string data(reinterpret_cast<const char*>(opened.data()),
                           static_cast<std::size_t>(opened.size()) * sizeof(double));
    return make_record(Kind::head, 0,
                       {{"mesh", head.mesh},
                        {"saved", head.saved},
                        {"clean", head.clean},
                        {"topology", fmt::format("{:x}", head.topology)},
                        {"nodes", opened.rows()}},
                       data);
}

std::string journal_step(std::uint32_t number, int at, const JournalStep& step, const Coordinates& before,
                         const Coordinates& after) {
    std::vector<Index> nodes;
    for (Eigen::Index node = 0; node < after.rows(); ++node)
        if (std::memcmp(before.data() + 3 * node, after.data() + 3 * node, 3 * sizeof(double)) != 0)
            nodes.push_back(static_cast<Index>(node));
    const std::string action = to_json_line(step.action);
    std::string data;
    data.reserve(16 + action.size() + nodes.size() * (sizeof(Index) + 3 * sizeof(double)));
    put(data, static_cast<std::uint64_t>(action.size()));
    data += action;
    put(data, static_cast<std::uint64_t>(nodes.size()));
    data.append(reinterpret_cast<const char*>(nodes.data()), nodes.size() * sizeof(Index));
    for (const Index node : nodes)
        data.append(reinterpret_cast<const char*>(after.data() + 3 * static_cast<std::ptrdiff_t>(node)),
                    3 * sizeof(double));
    return make_record(
        Kind::step, number,
        {{"at", at}, {"name", step.name}, {"details", step.details}, {"applied", step.applied_deformations}}, data);
}

std::string journal_jump(std::uint32_t number, int index) {
    return make_record(Kind::jump, number, {{"step", index}}, {});
}

std::string journal_clean(std::uint32_t number, int clean, const std::string& saved) {
    return make_record(Kind::clean, number, {{"clean", clean}, {"saved", saved}}, {});
}

std::string journal_deformation(std::uint32_t number, const std::string& file) {
    return make_record(Kind::deformation, number, {{"file", file}}, {});
}

JournalSummary summarize_journal(const std::filesystem::path& file) {
    Scanner scanner(file);
    const JournalHead head = read_head(scanner, false);
    JournalSummary summary;
    summary.mesh = head.mesh;
    summary.saved = head.saved;
    Standing standing{0, 0, head.clean};
    std::vector<std::string> names;
    try {
        while (!scanner.is_at_end()) {
            scanner.read(false);
            switch (scanner.kind()) {
                case Kind::step:
                    standing.step(scanner.number("at"));
                    names.resize(static_cast<std::size_t>(standing.index) - 1);
                    names.push_back(scanner.text("name"));
                    break;
                case Kind::jump:
                    standing.jump(scanner.number("step"));
                    break;
                case Kind::clean:
                    standing.set_clean(scanner.number("clean"));
                    summary.saved = scanner.text("saved");
                    break;
                default:
                    break;
            }
            summary.time = scanner.number("time");
            scanner.accept();
        }
    } catch (const InvalidInput&) {
        // What comes before is good.
    }
    names.resize(static_cast<std::size_t>(standing.index));
    summary.steps = std::move(names);
    summary.index = standing.index;
    summary.clean = standing.clean;
    return summary;
}

JournalContent read_journal(const std::filesystem::path& file, const TaskContext& context) {
    Scanner scanner(file);
    JournalContent content;
    content.head = read_head(scanner, true);
    const auto nodes = static_cast<Eigen::Index>(scanner.data_size() / 24);
    content.opened.resize(nodes, 3);
    std::copy_n(scanner.data().data(), scanner.data_size(), reinterpret_cast<char*>(content.opened.data()));
    if (!content.opened.allFinite())
        throw scanner.fail("the kept work has positions that are not finite; nothing of it can be recovered.");
    content.session.emplace_back(OpenAction{content.head.mesh});
    content.intact_bytes = scanner.position();
    content.records = 1;
    Standing standing{0, 0, content.head.clean};
    try {
        while (!scanner.is_at_end()) {
            context.report("reading", static_cast<double>(scanner.position()) / static_cast<double>(scanner.size()));
            scanner.read(true);
            switch (scanner.kind()) {
                case Kind::step: {
                    Standing next = standing;
                    next.step(scanner.number("at"));
                    JournalContent::Step step;
                    step.name = scanner.text("name");
                    step.details = scanner.text("details");
                    step.applied_deformations = scanner.texts("applied");
                    Pieces pieces(scanner.data());
                    step.action = parse_action(pieces.take(pieces.take_number()));
                    if (std::holds_alternative<OpenAction>(step.action) ||
                        std::holds_alternative<HistoryAction>(step.action))
                        throw InvalidInput("a step is none.");
                    step.positions = standing.index == 0
                                         ? content.opened
                                         : content.steps[static_cast<std::size_t>(standing.index) - 1].positions;
                    move_nodes(pieces, step.positions);
                    content.steps.resize(static_cast<std::size_t>(standing.index));
                    content.session.push_back(step.action);
                    content.steps.push_back(std::move(step));
                    standing = next;
                    break;
                }
                case Kind::jump:
                    standing.jump(scanner.number("step"));
                    content.session.emplace_back(HistoryAction{standing.index});
                    break;
                case Kind::clean: {
                    std::string saved = scanner.text("saved");
                    standing.set_clean(scanner.number("clean"));
                    content.head.saved = std::move(saved);
                    break;
                }
                case Kind::deformation:
                    content.deformation = scanner.text("file");
                    break;
                default:
                    throw InvalidInput("a record is of an unknown kind.");
            }
            scanner.accept();
            content.intact_bytes = scanner.position();
            ++content.records;
        }
    } catch (const InvalidInput& problem) {
        content.damage = problem.what();
    }
    content.index = standing.index;
    content.head.clean = standing.clean;
    return content;
}

JournalFile::JournalFile(std::filesystem::path file, std::uint64_t kept_bytes)
    : file_(std::move(file)), size_(kept_bytes) {}

JournalFile::~JournalFile() {
    if (handle_ >= 0) ::close(handle_);
}

bool JournalFile::open() {
    if (handle_ >= 0) return true;
    // For nobody else's eyes: unsaved work.
    handle_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (handle_ < 0) return false;
    if (size_ > 0) return true;
    std::string start(magic, sizeof magic);
    put(start, byte_order);
    return write(start);
}

bool JournalFile::write(const std::string& bytes) {
    // Whatever is there behind what is whole goes, so that nothing half-written stays.
    if (::ftruncate(handle_, static_cast<off_t>(size_)) != 0) return false;
    std::uint64_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count =
            ::pwrite(handle_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(size_ + done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            if (::ftruncate(handle_, static_cast<off_t>(size_)) != 0) return false;
            return false;
        }
        done += static_cast<std::uint64_t>(count);
    }
    size_ += bytes.size();
    return true;
}

bool JournalFile::append(std::string record) {
    waiting_.push_back(std::move(record));
    std::size_t written = 0;
    while (written < waiting_.size() && open() && write(waiting_[written])) ++written;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(written));
    if (!waiting_.empty()) return false;
    ::fdatasync(handle_);
    return true;
}

}  // namespace curvewright
