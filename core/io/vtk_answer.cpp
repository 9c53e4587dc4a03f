#include "core/io/vtk_answer.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

constexpr std::size_t alignment = 8;
constexpr std::uint32_t no_name = std::numeric_limits<std::uint32_t>::max();

// Types of arrays besides VTK's numbers for them: what VTK knows under a name of its own, and what holds no numbers.
constexpr std::int32_t type_int64 = 1000, type_other = 1001;

struct Head {
    std::array<char, 8> magic{};
    std::uint64_t size = 0, types = 0, offsets = 0, connectivity = 0;
};

struct ArrayHead {
    std::int32_t type = type_other;
    std::uint32_t components = 0;
    std::int32_t attribute = -1;  ///< VTK's number of what the array is to its points or cells; -1 = nothing
    std::uint32_t name_length = no_name;
    std::uint64_t tuples = 0, bytes = 0;
};

// ------------------------------------------------------------------------------------------------------- writing

class AnswerWriter {
  public:
    explicit AnswerWriter(int descriptor) : descriptor_(descriptor) {}

    bool write(vtkUnstructuredGrid& grid) {
        vtkCellArray* cells = grid.GetCells();
        vtkUnsignedCharArray* types = grid.GetCellTypesArray();
        Head head;
        std::memcpy(head.magic.data(), vtk_answer_magic, head.magic.size());
        head.types = types != nullptr ? static_cast<std::uint64_t>(types->GetNumberOfValues()) : 0;
        head.offsets = cells != nullptr ? static_cast<std::uint64_t>(cells->GetOffsetsArray()->GetNumberOfValues()) : 0;
        head.connectivity =
            cells != nullptr ? static_cast<std::uint64_t>(cells->GetConnectivityArray()->GetNumberOfValues()) : 0;
        put(&head, sizeof head);
        put_array(grid.GetPoints() != nullptr ? grid.GetPoints()->GetData() : nullptr, -1);
        if (types != nullptr) put(types->GetPointer(0), head.types);
        if (cells != nullptr) {
            put_integers(*cells->GetOffsetsArray());
            put_integers(*cells->GetConnectivityArray());
        }
        put_arrays(*grid.GetPointData(), grid.GetPointData());
        put_arrays(*grid.GetCellData(), grid.GetCellData());
        put_arrays(*grid.GetFieldData(), nullptr);
        flush();
        head.size = written_;
        return is_good_ && ::pwrite(descriptor_, &head, sizeof head, 0) == static_cast<ssize_t>(sizeof head);
    }

  private:
    void flush() {
        send(buffer_.data(), buffer_.size());
        buffer_.clear();
    }
    void send(const char* data, std::size_t size) {
        while (is_good_ && size > 0) {
            const ssize_t sent = ::write(descriptor_, data, size);
            if (sent < 0 && errno == EINTR) continue;
            is_good_ = sent > 0;
            if (!is_good_) return;
            data += sent;
            size -= static_cast<std::size_t>(sent);
            written_ += static_cast<std::uint64_t>(sent);
        }
    }
    /// Small things are collected, large ones go as they are.
    void put(const void* data, std::size_t size) {
        const char* bytes = static_cast<const char*>(data);
        if (size > 4096) {
            flush();
            send(bytes, size);
        } else if (size > 0) {
            buffer_.insert(buffer_.end(), bytes, bytes + size);
        }
        buffer_.resize(buffer_.size() + (alignment - size % alignment) % alignment);
    }
    void put_integers(vtkDataArray& array) {
        const vtkIdType count = array.GetNumberOfValues();
        if (array.GetDataTypeSize() == 8) {
            put(array.GetVoidPointer(0), 8 * static_cast<std::size_t>(count));
            return;
        }
        std::vector<std::int64_t> wide(static_cast<std::size_t>(count));
        for (vtkIdType i = 0; i < count; ++i)
            wide[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(array.GetTuple1(i));
        put(wide.data(), 8 * wide.size());
    }
    void put_arrays(vtkFieldData& data, vtkDataSetAttributes* attributes) {
        const auto count = static_cast<std::uint64_t>(data.GetNumberOfArrays());
        put(&count, sizeof count);
        for (int i = 0; i < data.GetNumberOfArrays(); ++i)
            put_array(data.GetAbstractArray(i), attributes != nullptr ? attributes->IsArrayAnAttribute(i) : -1);
    }
    void put_array(vtkAbstractArray* array, int attribute) {
        ArrayHead head;
        head.attribute = attribute;
        if (array == nullptr) {
            put(&head, sizeof head);
            return;
        }
        const std::string name = array->GetName() != nullptr ? array->GetName() : "";
        if (array->GetName() != nullptr) head.name_length = static_cast<std::uint32_t>(name.size());
        head.components = static_cast<std::uint32_t>(array->GetNumberOfComponents());
        head.tuples = static_cast<std::uint64_t>(array->GetNumberOfTuples());
        auto* numbers = vtkDataArray::SafeDownCast(array);
        auto* strings = vtkStringArray::SafeDownCast(array);
        std::vector<char> made;
        const void* data = nullptr;
        if (numbers != nullptr && array->GetDataType() == VTK_BIT) {
            head.type = VTK_UNSIGNED_CHAR;
            for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
                for (int c = 0; c < array->GetNumberOfComponents(); ++c)
                    made.push_back(static_cast<char>(numbers->GetComponent(i, c)));
        } else if (numbers != nullptr) {
            head.type = vtkTypeInt64Array::SafeDownCast(array) != nullptr ? type_int64 : array->GetDataType();
            head.bytes = head.tuples * head.components * static_cast<std::uint64_t>(array->GetDataTypeSize());
            data = head.bytes > 0 ? numbers->GetVoidPointer(0) : nullptr;
        } else if (strings != nullptr) {
            head.type = VTK_STRING;
            for (vtkIdType i = 0; i < strings->GetNumberOfValues(); ++i) {
                const std::string text = strings->GetValue(i);
                const std::uint64_t length = text.size();
                made.resize(made.size() + sizeof length);
                std::memcpy(made.data() + made.size() - sizeof length, &length, sizeof length);
                made.insert(made.end(), text.begin(), text.end());
            }
        }
        if (data == nullptr) {
            head.bytes = made.size();
            data = made.data();
        }
        put(&head, sizeof head);
        put(name.data(), name.size());
        put(data, head.bytes);
    }

    int descriptor_;
    bool is_good_ = true;
    std::uint64_t written_ = 0;
    std::vector<char> buffer_;
};

// ------------------------------------------------------------------------------------------------------- reading

class AnswerReader {
  public:
    explicit AnswerReader(std::span<std::byte> bytes) : bytes_(bytes) {}

    vtkSmartPointer<vtkUnstructuredGrid> read() {
        const auto head = value<Head>();
        if (std::memcmp(head.magic.data(), vtk_answer_magic, head.magic.size()) != 0)
            fail("it does not begin as an answer of this version does");
        if (head.size != bytes_.size())
            fail(fmt::format("it is {} bytes long instead of {}", bytes_.size(), head.size));
        auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
        if (const auto points = read_array().array) {
            auto* numbers = vtkDataArray::SafeDownCast(points);
            if (numbers == nullptr || numbers->GetNumberOfComponents() != 3) fail("its points have no coordinates");
            vtkNew<vtkPoints> positions;
            positions->SetData(numbers);
            grid->SetPoints(positions);
        }
        const auto types = integers<vtkUnsignedCharArray>(head.types, 1);
        const auto offsets = integers<vtkTypeInt64Array>(head.offsets, 8);
        const auto connectivity = integers<vtkTypeInt64Array>(head.connectivity, 8);
        if (head.offsets > 0) {
            if (head.offsets != head.types + 1) fail("its numbers of offsets and cell types do not agree");
            vtkNew<vtkCellArray> cells;
            cells->SetData(offsets, connectivity);
            grid->SetCells(types, cells, nullptr, nullptr);  // the other one would look for faces of polyhedra
        }
        read_arrays(*grid->GetPointData(), grid->GetPointData());
        read_arrays(*grid->GetCellData(), grid->GetCellData());
        read_arrays(*grid->GetFieldData(), nullptr);
        if (at_ != bytes_.size()) fail("something stands behind its end");
        return grid;
    }

  private:
    struct Named {
        vtkSmartPointer<vtkAbstractArray> array;
        int attribute = -1;
    };

    [[noreturn]] static void fail(const std::string& what) { throw InvalidInput(what); }

    /// The next `count` things of `size` bytes each, with what fills them up to the next part.
    std::byte* take(std::uint64_t count, std::uint64_t size = 1) {
        const std::uint64_t left = bytes_.size() - at_;
        if (size == 0 || count > left / size) fail("it ends too early");
        std::byte* begin = bytes_.data() + at_;
        const std::uint64_t length = count * size;
        at_ += std::min(left, length + (alignment - length % alignment) % alignment);
        return begin;
    }
    template <class T>
    T value() {
        T result;
        std::memcpy(&result, take(sizeof(T)), sizeof(T));
        return result;
    }
    template <class Array>
    vtkSmartPointer<Array> integers(std::uint64_t count, std::uint64_t size) {
        std::byte* data = take(count, size);
        auto array = vtkSmartPointer<Array>::New();
        if (count > 0) array->SetVoidArray(data, static_cast<vtkIdType>(count), 1);
        return array;
    }
    void read_arrays(vtkFieldData& data, vtkDataSetAttributes* attributes) {
        const auto count = value<std::uint64_t>();
        if (count > (bytes_.size() - at_) / sizeof(ArrayHead)) fail("it ends before its arrays");
        for (std::uint64_t i = 0; i < count; ++i) {
            const Named named = read_array();
            if (named.array == nullptr) continue;
            const int place = data.AddArray(named.array);
            if (attributes == nullptr || named.attribute < 0) continue;
            if (named.attribute >= vtkDataSetAttributes::NUM_ATTRIBUTES) fail("an array is of an unknown use");
            attributes->SetActiveAttribute(place, named.attribute);
        }
    }
    Named read_array() {
        const auto head = value<ArrayHead>();
        if (head.name_length == no_name && head.components == 0) return {};  // nothing stood there
        constexpr std::uint64_t most = std::numeric_limits<int>::max();
        if (head.components == 0 || head.components > most) fail("an array has no components");
        std::string name;
        if (head.name_length != no_name) {
            const auto* text = reinterpret_cast<const char*>(take(head.name_length));
            name.assign(text, head.name_length);
        }
        std::byte* data = take(head.bytes);
        vtkSmartPointer<vtkAbstractArray> array;
        if (head.type == VTK_STRING)
            array = strings(head, data);
        else if (head.type == type_other)
            array = vtkSmartPointer<vtkStringArray>::New();
        else
            array = numbers(head, data);
        if (head.name_length != no_name) array->SetName(name.c_str());
        return {array, head.attribute};
    }
    static vtkSmartPointer<vtkAbstractArray> numbers(const ArrayHead& head, std::byte* data) {
        constexpr std::array types = {VTK_CHAR,   VTK_SIGNED_CHAR,  VTK_UNSIGNED_CHAR, VTK_SHORT,
                                      VTK_INT,    VTK_UNSIGNED_INT, VTK_LONG,          VTK_UNSIGNED_SHORT,
                                      VTK_FLOAT,  VTK_ID_TYPE,      VTK_UNSIGNED_LONG, VTK_UNSIGNED_LONG_LONG,
                                      VTK_DOUBLE, VTK_LONG_LONG};
        const bool is_known =
            head.type == type_int64 || std::find(types.begin(), types.end(), head.type) != types.end();
        if (!is_known) fail(fmt::format("an array is of the unknown type {}", head.type));
        vtkSmartPointer<vtkDataArray> array;
        if (head.type == type_int64)
            array = vtkSmartPointer<vtkTypeInt64Array>::New();
        else
            array.TakeReference(vtkDataArray::CreateDataArray(head.type));
        const auto each = static_cast<std::uint64_t>(array->GetDataTypeSize()) * head.components;
        if (head.tuples != head.bytes / each || head.bytes % each != 0)
            fail("the length of an array is not that of its rows");
        array->SetNumberOfComponents(static_cast<int>(head.components));
        if (head.tuples > 0) array->SetVoidArray(data, static_cast<vtkIdType>(head.tuples * head.components), 1);
        return array;
    }
    static vtkSmartPointer<vtkAbstractArray> strings(const ArrayHead& head, const std::byte* data) {
        auto array = vtkSmartPointer<vtkStringArray>::New();
        array->SetNumberOfComponents(static_cast<int>(head.components));
        std::uint64_t left = head.bytes;
        for (std::uint64_t length = 0; left > 0; left -= length, data += length) {
            if (left < sizeof length) fail("a text ends too early");
            std::memcpy(&length, data, sizeof length);
            data += sizeof length;
            left -= sizeof length;
            if (length > left) fail("a text ends too early");
            array->InsertNextValue(std::string(reinterpret_cast<const char*>(data), length));
        }
        return array;
    }

    std::span<std::byte> bytes_;
    std::size_t at_ = 0;
};

}  // namespace

bool write_vtk_answer(vtkUnstructuredGrid& grid, int descriptor) {
    return AnswerWriter(descriptor).write(grid);
}

vtkSmartPointer<vtkUnstructuredGrid> grid_of_vtk_answer(std::span<std::byte> bytes) {
    return AnswerReader(bytes).read();
}

}  // namespace curvewright
