#include "node_tags.hpp"

#include <algorithm>
#include <string>

namespace evert {

void NodeTags::close(const InputCursor& in) {
  std::ranges::stable_sort(entries_, {}, &Entry::tag);
  const auto twin = std::ranges::adjacent_find(entries_, {}, &Entry::tag);
  if (twin != entries_.end())
    in.fail_at(std::next(twin)->position,
               "node tag " + std::to_string(twin->tag) + " is given a second time");
}

GlobalIndex NodeTags::index_of(std::int64_t tag, const InputCursor& in) const {
  if (!entries_.empty()) {
    // Almost all files number their nodes without gaps.
    const auto first = entries_.front().tag;
    const auto guess = static_cast<std::uint64_t>(tag) - static_cast<std::uint64_t>(first);
    if (guess < entries_.size() && entries_[guess].tag == tag) return entries_[guess].index;
    const auto found = std::ranges::lower_bound(entries_, tag, {}, &Entry::tag);
    if (found != entries_.end() && found->tag == tag) return found->index;
  }
  std::string known = "there are no nodes";
  if (!entries_.empty())
    known = "the nodes go from " + std::to_string(entries_.front().tag) + " to " +
            std::to_string(entries_.back().tag);
  in.fail("there is no node " + std::to_string(tag) + "; " + known);
}

}  // namespace evert
