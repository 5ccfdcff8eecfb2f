#pragma once
#include <cstdint>
#include <string>

/// What every writer needs of the file system. Not collective: one rank calls these, within on_root or
/// on_every_rank. All throw UserError naming the path and the system's reason.
namespace evert {

/// Creates the directories above `path` where they are missing, and makes sure that `path` can be written
/// (without changing a file that is there).
void require_writable(const std::string& path);

/// Makes sure that `bytes` more can be written at the end of `path`: reserves them where the file system can,
/// else looks at the free space. Fails before anything is half written.
void reserve_space(const std::string& path, std::int64_t bytes);

/// Waits until the file is on the disk.
void sync_file(const std::string& path);

/// `from` takes the place of `to` in one step that survives a crash.
void replace_file(const std::string& from, const std::string& to);

/// A file with this content takes the place of `path` in one step: readers see the old or the new one. What a
/// link points to is replaced, not the link; pipes and devices (/dev/stdout) are written to.
void write_file(const std::string& path, const std::string& content);

}  // namespace evert
