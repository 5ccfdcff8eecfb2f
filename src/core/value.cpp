#include "evert/core/value.hpp"

#include "evert/core/error.hpp"

#include <algorithm>

namespace evert::schema {
namespace {

std::string escaped(std::string_view text) {
  static constexpr std::string_view digits = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code == '\n') {
      out += "\\n";
    } else if (code < 0x20 || code == 0x7f) {
      out += "\\x";
      out += digits[code >> 4U];
      out += digits[code & 15U];
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto it = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.first == key; });
  return it == entries.end() ? nullptr : &it->second;
}

Value* Value::find(std::string_view key) { return const_cast<Value*>(std::as_const(*this).find(key)); }

void Value::set(const std::string& key, Value value) {
  kind = Kind::map;
  if (auto* present = find(key))
    *present = std::move(value);
  else
    entries.emplace_back(key, std::move(value));
}

void Value::erase(std::string_view key) {
  std::erase_if(entries, [&](const auto& entry) { return entry.first == key; });
}

std::string join(std::string_view path, std::string_view key) {
  return path.empty() ? std::string(key) : std::string(path) + "." + std::string(key);
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 60;
  const bool cut = text.size() > longest;
  return std::string("'").append(escaped(text.substr(0, longest))).append(cut ? "...'" : "'");
}

std::string shown(const Value& value) {
  switch (value.kind) {
    case Value::Kind::null:
      return "nothing";
    case Value::Kind::scalar:
      return shown(value.text);
    case Value::Kind::list:
      return "a list";
    case Value::Kind::map:
      return "a map of keys";
  }
  return {};
}

std::string canonical_text(const Value& value) {
  switch (value.kind) {
    case Value::Kind::null:
      return "null";
    case Value::Kind::scalar: {
      if (!value.quoted) return value.text;
      std::string out = "\"";
      for (const char c : value.text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' ? std::string("\\n") : std::string(1, c);
      }
      return out + '"';
    }
    case Value::Kind::list: {
      std::string out = "[";
      for (const auto& item : value.items) out += (out.size() > 1 ? ", " : "") + canonical_text(item);
      return out + "]";
    }
    case Value::Kind::map: {
      std::string out = "{";
      for (const auto& [key, entry] : value.entries)
        out += (out.size() > 1 ? ", " : "") + key + ": " + canonical_text(entry);
      return out + "}";
    }
  }
  return {};
}

void fail(const Value& value, std::string_view path, const std::string& sentence) {
  std::string message = value.where;
  const bool said = message.ends_with(path);  // by an override, whose place is its path
  if (!said) message += (message.empty() ? "" : ": ") + std::string(path);
  throw UserError(message + (message.empty() ? "" : ": ") + sentence);
}

}  // namespace evert::schema
