#include "evert/io/hdf5_file.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace evert {
namespace {

using PropertyList = Hdf5Handle<H5Pclose>;
using DataSpace = Hdf5Handle<H5Sclose>;
using DataSet = Hdf5Handle<H5Dclose>;
using DataType = Hdf5Handle<H5Tclose>;
using Attribute = Hdf5Handle<H5Aclose>;
using Object = Hdf5Handle<H5Oclose>;
using Group = Hdf5Handle<H5Gclose>;

/// A call failed on this rank; becomes an Hdf5Error on all in Hdf5File::together.
class Hdf5Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The innermost message of HDF5's error stack: the real reason.
std::string innermost_reason() {
  std::string reason = "unknown reason";
  const auto take_first = [](unsigned depth, const H5E_error2_t* error, void* text) -> herr_t {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
    return 0;
  };
  static_cast<void>(H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason));
  return reason;
}

/// Passes on what an HDF5 call returned unless that means failure.
template <class Result>
Result checked(Result result) {
  if (result < 0) throw Hdf5Failure(innermost_reason());
  return result;
}

// clang-format off
hid_t native(double /*tag*/) { return H5T_NATIVE_DOUBLE; }
hid_t native(std::int64_t /*tag*/) { return H5T_NATIVE_INT64; }
hid_t native(std::int32_t /*tag*/) { return H5T_NATIVE_INT32; }
hid_t native(std::uint8_t /*tag*/) { return H5T_NATIVE_UINT8; }
// clang-format on

/// Metadata stays in memory until flush(), so that a kill in between leaves the file as it was then. The
/// format is one that older readers know and that needs no repair when the writer dies.
PropertyList shared_access(MPI_Comm comm) {
  PropertyList access(checked(H5Pcreate(H5P_FILE_ACCESS)));
  checked(H5Pset_fapl_mpio(access.get(), comm, MPI_INFO_NULL));
  checked(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V18, H5F_LIBVER_V18));
  H5AC_cache_config_t cache;
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  checked(H5Pget_mdc_config(access.get(), &cache));
  cache.evictions_enabled = false;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  checked(H5Pset_mdc_config(access.get(), &cache));
  return access;
}

/// Without locks, which some parallel file systems lack; a file is consistent whenever it is not being
/// flushed.
PropertyList lone_access() {
  PropertyList access(checked(H5Pcreate(H5P_FILE_ACCESS)));
  checked(H5Pset_file_locking(access.get(), false, true));
  return access;
}

DataSpace space_of(TableShape shape) {
  const std::array<hsize_t, 2> extent{static_cast<hsize_t>(shape.rows), static_cast<hsize_t>(shape.width)};
  return DataSpace(checked(H5Screate_simple(shape.width == 1 ? 1 : 2, extent.data(), nullptr)));
}

/// Selects rows in `file` and returns the space of as many in memory.
DataSpace select(const DataSpace& file, TableShape shape, RowRange rows) {
  DataSpace memory = space_of({rows.count, shape.width});
  if (rows.count == 0) {
    checked(H5Sselect_none(file.get()));
    checked(H5Sselect_none(memory.get()));
    return memory;
  }
  const std::array<hsize_t, 2> start{static_cast<hsize_t>(rows.first), 0};
  const std::array<hsize_t, 2> count{static_cast<hsize_t>(rows.count), static_cast<hsize_t>(shape.width)};
  checked(H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  return memory;
}

TableShape shape_of_set(const DataSet& set) {
  const DataSpace space(checked(H5Dget_space(set.get())));
  const int dimensions = checked(H5Sget_simple_extent_ndims(space.get()));
  if (dimensions != 1 && dimensions != 2) throw Hdf5Failure("a table of other than one or two dimensions");
  std::array<hsize_t, 2> extent{0, 1};
  checked(H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr));
  return {static_cast<GlobalIndex>(extent[0]), static_cast<GlobalIndex>(extent[1])};
}

template <class T>
void write_rows(const DataSet& set, TableShape shape, RowRange rows, std::span<const T> values) {
  const DataSpace file = space_of(shape);
  const DataSpace memory = select(file, shape, rows);
  const PropertyList transfer(checked(H5Pcreate(H5P_DATASET_XFER)));
  checked(H5Pset_dxpl_mpio(transfer.get(), H5FD_MPIO_COLLECTIVE));
  checked(H5Dwrite(set.get(), native(T{}), memory.get(), file.get(), transfer.get(), values.data()));
}

// --- attributes: each kind of value as a type, an extent and bytes

DataType string_type(std::size_t length) {
  DataType type(checked(H5Tcopy(H5T_C_S1)));
  checked(H5Tset_size(type.get(), std::max<std::size_t>(length, 1)));
  checked(H5Tset_strpad(type.get(), H5T_STR_NULLPAD));
  return type;
}

void write_attribute(hid_t object, const std::string& name, hid_t type, const DataSpace& space,
                     const void* data) {
  if (checked(H5Aexists(object, name.c_str())) > 0) checked(H5Adelete(object, name.c_str()));
  const Attribute attribute(
      checked(H5Acreate2(object, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT)));
  // HDF5 takes no null buffer, not even for nothing.
  if (checked(H5Sget_simple_extent_npoints(space.get())) > 0) checked(H5Awrite(attribute.get(), type, data));
}

template <class T>
void put(hid_t object, const std::string& name, const T& value) {
  write_attribute(object, name, native(T{}), DataSpace(checked(H5Screate(H5S_SCALAR))), &value);
}

template <class T>
void put(hid_t object, const std::string& name, const std::vector<T>& values) {
  write_attribute(object, name, native(T{}), space_of({static_cast<GlobalIndex>(values.size()), 1}),
                  values.data());
}

void put(hid_t object, const std::string& name, const std::string& value) {
  const auto padded = value.empty() ? std::string(1, '\0') : value;
  write_attribute(object, name, string_type(value.size()).get(), DataSpace(checked(H5Screate(H5S_SCALAR))),
                  padded.data());
}

void put(hid_t object, const std::string& name, const std::vector<std::string>& values) {
  std::size_t longest = 1;
  for (const auto& value : values) longest = std::max(longest, value.size());
  std::string bytes;
  for (const auto& value : values) (bytes += value).resize(bytes.size() + longest - value.size(), '\0');
  write_attribute(object, name, string_type(longest).get(),
                  space_of({static_cast<GlobalIndex>(values.size()), 1}), bytes.data());
}

/// An attribute of an object, with the number of its values.
struct OpenAttribute {
  Attribute attribute;
  std::size_t count;
};

OpenAttribute open_attribute(hid_t object, const std::string& name) {
  OpenAttribute open{Attribute(checked(H5Aopen(object, name.c_str(), H5P_DEFAULT))), 0};
  const DataSpace space(checked(H5Aget_space(open.attribute.get())));
  open.count = static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space.get())));
  return open;
}

template <class T>
void get(hid_t object, const std::string& name, std::vector<T>& values) {
  const auto open = open_attribute(object, name);
  values.resize(open.count);
  if (open.count > 0) checked(H5Aread(open.attribute.get(), native(T{}), values.data()));
}

void get(hid_t object, const std::string& name, std::vector<std::string>& values) {
  const auto open = open_attribute(object, name);
  const DataType type(checked(H5Aget_type(open.attribute.get())));
  if (H5Tget_class(type.get()) != H5T_STRING || checked(H5Tis_variable_str(type.get())) > 0)
    throw Hdf5Failure("attribute '" + name + "' is not a string of fixed length");
  const std::size_t length = H5Tget_size(type.get());
  std::string bytes(open.count * length, '\0');
  if (open.count > 0) checked(H5Aread(open.attribute.get(), type.get(), bytes.data()));
  values.clear();
  for (std::size_t i = 0; i < open.count; ++i) {
    const auto padded = bytes.substr(i * length, length);
    values.push_back(padded.substr(0, padded.find('\0')));
  }
}

template <class T>
void get(hid_t object, const std::string& name, T& value) {
  std::vector<T> values;
  get(object, name, values);
  if (values.size() != 1) throw Hdf5Failure("attribute '" + name + "' is not a single value");
  value = values.front();
}

}  // namespace

void Hdf5File::together(const std::string& verb, const std::function<void()>& work) const {
  std::string reason;
  try {
    work();
  } catch (const Hdf5Failure& failure) {
    reason = failure.what();
  }
  try {
    agree_or_throw(comm_, reason);
  } catch (const UserError& agreed) {
    throw Hdf5Error("cannot " + verb + " '" + path_ + "'", agreed.what());
  }
}

Hdf5File::Hdf5File(MPI_Comm comm, std::string path) : comm_(comm), path_(std::move(path)) {
  static_cast<void>(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr));
}

Hdf5File Hdf5File::create(MPI_Comm comm, const std::string& path) {
  Hdf5File file(comm, path);
  file.together("write", [&] {
    const auto access = shared_access(comm);
    file.file_ =
        Hdf5Handle<H5Fclose>(checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get())));
  });
  return file;
}

Hdf5File Hdf5File::open(MPI_Comm comm, const std::string& path, Access access) {
  Hdf5File file(comm, path);
  // Each rank reads by itself: no rank can wait for another that met an error.
  file.together("read", [&] {
    const auto alone = lone_access();
    file.file_ = Hdf5Handle<H5Fclose>(checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, alone.get())));
  });
  if (access == Access::read) return file;
  file.file_ = {};
  file.together("write", [&] {
    const auto shared = shared_access(comm);
    file.file_ = Hdf5Handle<H5Fclose>(checked(H5Fopen(path.c_str(), H5F_ACC_RDWR, shared.get())));
  });
  return file;
}

bool Hdf5File::contains(const std::string& object) const {
  bool found = true;
  together("read", [&] {
    // H5Lexists wants every step of the way to exist.
    for (std::size_t end = object.find('/', 1); found; end = object.find('/', end + 1)) {
      found = checked(H5Lexists(file_.get(), object.substr(0, end).c_str(), H5P_DEFAULT)) > 0;
      if (end == std::string::npos) break;
    }
  });
  return found;
}

void Hdf5File::create_group(const std::string& group) {
  together("write", [&] {
    const Group created(
        checked(H5Gcreate2(file_.get(), group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
  });
}

std::vector<std::string> Hdf5File::names_in(const std::string& group) const {
  std::vector<std::string> names;
  together("read", [&] {
    const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
      static_cast<std::vector<std::string>*>(list)->emplace_back(name);
      return 0;
    };
    const Group opened(checked(H5Gopen2(file_.get(), group.c_str(), H5P_DEFAULT)));
    checked(H5Literate(opened.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names));
  });
  std::sort(names.begin(), names.end());
  return names;
}

void Hdf5File::remove(const std::string& object) {
  together("write", [&] { checked(H5Ldelete(file_.get(), object.c_str(), H5P_DEFAULT)); });
}

TableShape Hdf5File::shape_of(const std::string& table) const {
  TableShape shape;
  together("read", [&] {
    shape = shape_of_set(DataSet(checked(H5Dopen2(file_.get(), table.c_str(), H5P_DEFAULT))));
  });
  return shape;
}

template <class T>
void Hdf5File::write(const std::string& table, TableShape shape, RowRange rows, std::span<const T> values) {
  together("write", [&] {
    const PropertyList creation(checked(H5Pcreate(H5P_DATASET_CREATE)));
    checked(H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER));
    const DataSet set(checked(H5Dcreate2(file_.get(), table.c_str(), native(T{}), space_of(shape).get(),
                                         H5P_DEFAULT, creation.get(), H5P_DEFAULT)));
    write_rows(set, shape, rows, values);
  });
}

template <class T>
void Hdf5File::overwrite(const std::string& table, TableShape shape, RowRange rows,
                         std::span<const T> values) {
  together("write", [&] {
    const DataSet set(checked(H5Dopen2(file_.get(), table.c_str(), H5P_DEFAULT)));
    if (shape_of_set(set) != shape) throw Hdf5Failure("table '" + table + "' has another size");
    write_rows(set, shape, rows, values);
  });
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& table, RowRange rows) const {
  std::vector<T> values;
  together("read", [&] {
    const DataSet set(checked(H5Dopen2(file_.get(), table.c_str(), H5P_DEFAULT)));
    const auto shape = shape_of_set(set);
    if (rows.first < 0 || rows.count < 0 || rows.first > shape.rows - rows.count)
      throw Hdf5Failure("table '" + table + "' has only " + std::to_string(shape.rows) + " rows");
    const DataSpace file = space_of(shape);
    const DataSpace memory = select(file, shape, rows);
    values.resize(static_cast<std::size_t>(rows.count * shape.width));
    checked(H5Dread(set.get(), native(T{}), memory.get(), file.get(), H5P_DEFAULT, values.data()));
  });
  return values;
}

template <class T>
void Hdf5File::set_attribute(const std::string& object, const std::string& name, const T& value) {
  together("write", [&] {
    const Object owner(checked(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT)));
    put(owner.get(), name, value);
  });
}

template <class T>
T Hdf5File::attribute(const std::string& object, const std::string& name) const {
  T value{};
  together("read", [&] {
    const Object owner(checked(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT)));
    get(owner.get(), name, value);
  });
  return value;
}

void Hdf5File::flush() {
  together("write", [&] { checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL)); });
}

void Hdf5File::close() {
  together("write", [&] { checked(H5Fclose(file_.release())); });
}

#define EVERT_INSTANTIATE_TABLE(T)                                                                    \
  template void Hdf5File::write<T>(const std::string&, TableShape, RowRange, std::span<const T>);     \
  template void Hdf5File::overwrite<T>(const std::string&, TableShape, RowRange, std::span<const T>); \
  template std::vector<T> Hdf5File::read<T>(const std::string&, RowRange) const;
EVERT_INSTANTIATE_TABLE(double)
EVERT_INSTANTIATE_TABLE(std::int64_t)
EVERT_INSTANTIATE_TABLE(std::int32_t)
EVERT_INSTANTIATE_TABLE(std::uint8_t)
#undef EVERT_INSTANTIATE_TABLE

#define EVERT_INSTANTIATE_ATTRIBUTE(T)                                                        \
  template void Hdf5File::set_attribute<T>(const std::string&, const std::string&, const T&); \
  template T Hdf5File::attribute<T>(const std::string&, const std::string&) const;
EVERT_INSTANTIATE_ATTRIBUTE(double)
EVERT_INSTANTIATE_ATTRIBUTE(std::int64_t)
EVERT_INSTANTIATE_ATTRIBUTE(std::string)
EVERT_INSTANTIATE_ATTRIBUTE(std::vector<double>)
EVERT_INSTANTIATE_ATTRIBUTE(std::vector<std::int64_t>)
EVERT_INSTANTIATE_ATTRIBUTE(std::vector<std::string>)
#undef EVERT_INSTANTIATE_ATTRIBUTE

}  // namespace evert
