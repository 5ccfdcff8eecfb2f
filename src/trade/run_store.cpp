#include "evert/trade/run_store.hpp"

#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/io/files.hpp"
#include "evert/io/hdf5_file.hpp"

#include <array>
#include <cstdint>
#include <filesystem>

namespace evert::trade {
namespace {

namespace fs = std::filesystem;

/// FNV-1a of 64 bits: the same everywhere, unlike std::hash.
std::uint64_t digest(const std::string& text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return hash;
}

/// Name and values of each table of a record.
template <class Record>
auto tables_of(Record& record) {
  auto& m = record.measured;
  return std::array{std::pair{"displacement", &m.displacement},
                    std::pair{"probes", &m.probes},
                    std::pair{"kinetic", &m.kinetic},
                    std::pair{"potential", &m.potential},
                    std::pair{"volume", &m.volume},
                    std::pair{"cpu_seconds", &record.cpu_seconds}};
}

template <class Record>
auto scalars_of(Record& record) {
  return std::array{std::pair{"reached", &record.reached}, std::pair{"memory", &record.memory},
                    std::pair{"steps", &record.steps}, std::pair{"nodes", &record.nodes}};
}

/// An attribute holds no more than 64 KiB.
std::string as_attribute(const std::string& identity) { return identity.substr(0, 60'000); }

}  // namespace

std::string RunStore::path_of(const std::string& identity) const {
  return (fs::path(directory_) /
          (formatted("%016llx", static_cast<unsigned long long>(digest(identity))) + ".h5"))
      .string();
}

std::optional<RunRecord> RunStore::find(const std::string& identity) const {
  const auto path = path_of(identity);
  if (!fs::exists(path)) return std::nullopt;
  try {
    const auto file = Hdf5File::open(MPI_COMM_SELF, path, Hdf5File::Access::read);
    if (file.attribute<std::string>("/", "identity") != as_attribute(identity)) return std::nullopt;
    RunRecord record;
    record.fate = static_cast<Fate>(file.attribute<std::int64_t>("/", "fate"));
    record.message = file.attribute<std::string>("/", "message");
    for (auto [name, value] : scalars_of(record)) *value = file.attribute<double>("/", name);
    for (auto [name, values] : tables_of(record))
      if (file.contains(name)) *values = file.read<double>(name, {0, file.shape_of(name).rows});
    return record;
  } catch (const UserError&) {
    return std::nullopt;  // what cannot be read is run again
  }
}

void RunStore::keep(const std::string& identity, const RunRecord& record) const {
  const auto path = path_of(identity);
  const auto unfinished = path + ".part";
  require_writable(unfinished);
  auto file = Hdf5File::create(MPI_COMM_SELF, unfinished);
  file.set_attribute<std::string>("/", "identity", as_attribute(identity));
  file.set_attribute<std::int64_t>("/", "fate", static_cast<std::int64_t>(record.fate));
  file.set_attribute<std::string>("/", "message", record.message);
  for (auto [name, value] : scalars_of(record)) file.set_attribute<double>("/", name, *value);
  for (auto [name, values] : tables_of(record)) {
    const auto rows = static_cast<GlobalIndex>(values->size());
    if (rows > 0) file.write<double>(name, {.rows = rows}, {0, rows}, *values);
  }
  file.close();
  replace_file(unfinished, path);
}

}  // namespace evert::trade
