#include "simulation/scene_builder.hpp"

#include "core/reading/scene_reader.hpp"

#include <filesystem>
#include <memory>

namespace kairos {
inline namespace simulation {
namespace {

Value value_of(decltype(Value::data) data) {
  static const auto no_file = std::make_shared<const std::string>();
  return {std::move(data), no_file, 0};
}

Table table_of(KeyValue::Keys keys) {
  Table table;
  for (const auto& [key, value] : keys) {
    table.set(std::string(key), value.document());
  }
  return table;
}

template <typename Element>
Array array_of(const std::vector<Element>& elements) {
  Array array;
  for (const Element& element : elements) {
    array.push_back(value_of(element));
  }
  return array;
}

}  // namespace

KeyValue::KeyValue(const std::vector<double>& numbers) : data_(array_of(numbers)) {}
KeyValue::KeyValue(const std::vector<std::string>& texts) : data_(array_of(texts)) {}
KeyValue::KeyValue(Keys keys) : data_(table_of(keys)) {}

Value KeyValue::document() const { return value_of(data_); }

SceneBuilder::SceneBuilder(std::string name, std::string folder) : folder_(std::move(folder)) {
  root_.set("name", value_of(std::move(name)));
}

SceneBuilder& SceneBuilder::set(std::string_view key, const KeyValue& value) {
  root_.set(std::string(key), value.document());
  return *this;
}

SceneBuilder& SceneBuilder::body(std::string_view name, KeyValue::Keys keys) {
  Table body;
  body.set("name", value_of(std::string(name)));
  for (const auto& [key, value] : keys) {
    body.set(std::string(key), value.document());
  }
  append("body", std::move(body));
  return *this;
}

SceneBuilder& SceneBuilder::add(std::string_view list, KeyValue::Keys keys) {
  append(list, table_of(keys));
  return *this;
}

void SceneBuilder::append(std::string_view list, Table element) {
  const std::string key(list);
  Value* present = root_.find(key);
  if (present == nullptr || present->array() == nullptr) {
    root_.set(key, value_of(Array{}));
    present = root_.find(key);
  }
  std::get<Array>(present->data).push_back(value_of(std::move(element)));
}

Scene SceneBuilder::scene() const {
  const std::filesystem::path folder(folder_);
  return read_scene_document(value_of(root_), folder.empty() ? "" : (folder / "").string());
}

std::string SceneBuilder::toml() const { return to_toml(root_); }

}  // namespace simulation
}  // namespace kairos
