#pragma once
#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/index.hpp"

#include <hdf5.h>
#include <mpi.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// HDF5 files, owned and checked. Every error becomes a UserError with HDF5's own reason, on all ranks that
/// share the file; HDF5 itself prints nothing.
namespace evert {

/// What Hdf5File throws: "cannot read 'run.h5': reason".
class Hdf5Error : public UserError {
 public:
  Hdf5Error(const std::string& doing, std::string reason)
      : UserError(doing + ": " + reason), reason_(std::move(reason)) {}
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// Owns one HDF5 identifier.
template <herr_t (*Close)(hid_t)>
class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  explicit Hdf5Handle(hid_t id) : id_(id) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, none)) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) static_cast<void>(Close(id_));
  }
  [[nodiscard]] hid_t get() const { return id_; }
  /// Gives the identifier away.
  [[nodiscard]] hid_t release() { return std::exchange(id_, none); }

 private:
  static constexpr hid_t none = -1;
  hid_t id_ = none;
};

/// Rows [first, first + count) of a dataset.
struct RowRange {
  GlobalIndex first = 0;
  GlobalIndex count = 0;
};

/// A dataset's size: `rows` of `width` values; one-dimensional on disk when the width is 1.
struct TableShape {
  GlobalIndex rows = 0;
  GlobalIndex width = 1;
  friend bool operator==(const TableShape&, const TableShape&) = default;
};

/// A file of groups, tables and attributes, on one rank or shared by a communicator through MPI-IO. All calls
/// are collective over that communicator and throw Hdf5Error on every rank when one fails on any.
class Hdf5File {
 public:
  /// Replaces what is at `path`.
  [[nodiscard]] static Hdf5File create(MPI_Comm comm, const std::string& path);
  enum class Access { read, write };
  [[nodiscard]] static Hdf5File open(MPI_Comm comm, const std::string& path, Access access);
  Hdf5File(Hdf5File&&) noexcept = default;
  Hdf5File& operator=(Hdf5File&&) noexcept = default;

  [[nodiscard]] bool contains(const std::string& object) const;
  void create_group(const std::string& group);
  /// Names in a group, sorted.
  [[nodiscard]] std::vector<std::string> names_in(const std::string& group) const;
  void remove(const std::string& object);

  // Tables of double, std::int64_t, std::int32_t and std::uint8_t. Each rank writes or reads its own rows.
  [[nodiscard]] TableShape shape_of(const std::string& table) const;
  template <class T>
  void write(const std::string& table, TableShape shape, RowRange rows, std::span<const T> values);
  /// The table must exist with this shape.
  template <class T>
  void overwrite(const std::string& table, TableShape shape, RowRange rows, std::span<const T> values);
  template <class T>
  [[nodiscard]] std::vector<T> read(const std::string& table, RowRange rows) const;

  // Attributes of groups and tables; writing replaces. T: double, std::int64_t, std::string and vectors of
  // them.
  template <class T>
  void set_attribute(const std::string& object, const std::string& name, const T& value);
  template <class T>
  [[nodiscard]] T attribute(const std::string& object, const std::string& name) const;

  /// All that was written reaches the operating system, with the file consistent.
  void flush();
  void close();
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Not collective: of this process among those that share the file.
  [[nodiscard]] int rank() const { return rank_of(comm_); }

 private:
  Hdf5File(MPI_Comm comm, std::string path);
  void together(const std::string& verb, const std::function<void()>& work) const;

  MPI_Comm comm_;
  std::string path_;
  Hdf5Handle<H5Fclose> file_;
};

}  // namespace evert
