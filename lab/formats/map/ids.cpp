// The ids of a map's features.
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "lab/formats/map/texts.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {

std::string MapIds::of(MapText& text, json::object& feature) const {
  if (!any()) return {};
  if (name_ == "id") {
    const std::optional<json::value> id = text.optional_field(feature, "id");
    if (!id) text.refuse("a feature without a member 'id'", "one, or the name of a property with --ids");
    return text.label(*id, "an id: a string or a number");
  }
  std::string_view property = name_;
  constexpr std::string_view prefix = "properties.";
  if (property.starts_with(prefix)) property.remove_prefix(prefix.size());
  const std::optional<json::value> properties = text.optional_field(feature, "properties");
  std::optional<json::value> id;
  if (properties) {
    json::object object = text.object(*properties, "an object of properties");
    id = text.optional_field(object, property);
  }
  if (!id)
    text.refuse(fmt::format("a feature without a property {}", shown(property)), "one, as --ids names it");
  return text.label(*id, "an id: a string or a number");
}

void MapIds::refuse(MapText& text, std::string_view found) const {
  if (any()) text.refuse(found, fmt::format("features, as --ids {} asks for their ids", name_));
}

}  // namespace broadside::lab
