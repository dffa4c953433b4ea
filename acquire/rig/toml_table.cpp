// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/nearest_name.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/acquire/rig/toml_table.hpp>

#include <cmath>
#include <cstdint>
#include <set>

#include <toml++/toml.h>

namespace facula {

struct TomlTable::Impl {
  std::shared_ptr<const toml::table> root;  ///< keeps the nodes of every part alive
  const toml::table* table = nullptr;
  std::filesystem::path file;
  std::string name;  ///< dotted name of this table, empty at the root
  std::set<std::string> asked;

  const toml::node* find(const std::string& key) {
    asked.insert(key);
    return table->get(key);
  }
};

TomlTable::TomlTable(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TomlTable::TomlTable(TomlTable&&) noexcept = default;
TomlTable& TomlTable::operator=(TomlTable&&) noexcept = default;
TomlTable::~TomlTable() = default;

TomlTable TomlTable::from_file(const std::filesystem::path& path) {
  require(std::filesystem::is_regular_file(path),
          "there is no file '",
          path.string(),
          "'; check the path");
  return from_text(read_whole_file(path), path.string());
}

TomlTable TomlTable::from_text(const std::string& text, const std::string& source) {
  auto impl = std::make_unique<Impl>();
  impl->file = source;
  try {
    impl->root = std::make_shared<const toml::table>(toml::parse(text, source));
  } catch (const toml::parse_error& error) {
    fail("'",
         source,
         "' is not valid TOML: line ",
         error.source().begin.line,
         ", column ",
         error.source().begin.column,
         ": ",
         error.description());
  }
  impl->table = impl->root.get();
  return TomlTable(std::move(impl));
}

std::string TomlTable::where(const std::string& key) const {
  return impl_->file.string() + ", key '" + (impl_->name.empty() ? "" : impl_->name + ".") + key +
         "'";
}

std::filesystem::path TomlTable::folder() const {
  return impl_->file.parent_path();
}

bool TomlTable::has(const std::string& key) const {
  return impl_->table->contains(key);
}

std::optional<double> TomlTable::number_if(const std::string& key) {
  const toml::node* node = impl_->find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value<double>();
  require(node->is_number() && value.has_value(), where(key), ": expected a number");
  require(std::isfinite(*value), where(key), ": expected a finite number, got ", *value);
  return value;
}

std::optional<int> TomlTable::integer_if(const std::string& key) {
  const toml::node* node = impl_->find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value<std::int64_t>();
  require(node->is_integer() && value.has_value() && *value > -1000000000 && *value < 1000000000,
          where(key),
          ": expected a whole number below 1e9");
  return static_cast<int>(*value);
}

std::optional<std::string> TomlTable::text_if(const std::string& key) {
  const toml::node* node = impl_->find(key);
  if (node == nullptr) return std::nullopt;
  require(node->is_string(), where(key), ": expected a text in quotes");
  return node->value<std::string>();
}

std::optional<bool> TomlTable::boolean_if(const std::string& key) {
  const toml::node* node = impl_->find(key);
  if (node == nullptr) return std::nullopt;
  require(node->is_boolean(), where(key), ": expected true or false");
  return node->value<bool>();
}

namespace {

const toml::array& list_in(const toml::node* node, const std::string& where, const char* of) {
  require(node != nullptr, where, ": missing; expected a list of ", of);
  require(node->is_array(), where, ": expected a list of ", of);
  return *node->as_array();
}

std::vector<double> finite_numbers(const toml::array& list, const std::string& where) {
  std::vector<double> result;
  for (const toml::node& entry : list) {
    const auto value = entry.value<double>();
    require(entry.is_number() && value.has_value() && std::isfinite(*value),
            where,
            ": expected finite numbers only");
    result.push_back(*value);
  }
  return result;
}

}  // namespace

std::vector<double> TomlTable::numbers(const std::string& key) {
  return finite_numbers(list_in(impl_->find(key), where(key), "numbers"), where(key));
}

std::vector<std::vector<double>> TomlTable::number_rows(const std::string& key) {
  std::vector<std::vector<double>> result;
  for (const toml::node& row : list_in(impl_->find(key), where(key), "lists of numbers")) {
    require(row.is_array(), where(key), ": expected lists of numbers such as [[1, 2], [2, 5]]");
    result.push_back(finite_numbers(*row.as_array(), where(key)));
  }
  return result;
}

std::vector<std::string> TomlTable::texts(const std::string& key) {
  std::vector<std::string> result;
  for (const toml::node& entry : list_in(impl_->find(key), where(key), "texts")) {
    const auto value = entry.value<std::string>();
    require(entry.is_string() && value.has_value(), where(key), ": expected texts in quotes only");
    result.push_back(*value);
  }
  return result;
}

std::optional<Eigen::Vector3d> TomlTable::vector3_if(const std::string& key) {
  if (!has(key)) {
    impl_->asked.insert(key);
    return std::nullopt;
  }
  const std::vector<double> values = numbers(key);
  require(values.size() == 3, where(key), ": expected 3 numbers, got ", values.size());
  return Eigen::Vector3d(values[0], values[1], values[2]);
}

std::vector<Eigen::Vector2d> TomlTable::pairs(const std::string& key) {
  std::vector<Eigen::Vector2d> result;
  const toml::node* node = impl_->find(key);
  if (node == nullptr) return result;
  const toml::array* list = node->as_array();
  require(list != nullptr, where(key), ": expected a list of pairs");
  for (const toml::node& entry : *list) {
    const toml::array* pair = entry.as_array();
    require(pair != nullptr && pair->size() == 2 && pair->get(0)->is_number() &&
                pair->get(1)->is_number(),
            where(key),
            ": expected pairs of numbers such as [0, 100]");
    result.emplace_back(*pair->get(0)->value<double>(), *pair->get(1)->value<double>());
    require(result.back().allFinite(), where(key), ": expected finite numbers only");
  }
  return result;
}

namespace {

template <typename T>
T required(std::optional<T> value, const std::string& where, const char* kind) {
  require(value.has_value(), where, ": missing; expected ", kind);
  return *std::move(value);
}

}  // namespace

double TomlTable::number(const std::string& key) {
  return required(number_if(key), where(key), "a number");
}

int TomlTable::integer(const std::string& key) {
  return required(integer_if(key), where(key), "a whole number");
}

std::string TomlTable::text(const std::string& key) {
  return required(text_if(key), where(key), "a text in quotes");
}

Eigen::Vector3d TomlTable::vector3(const std::string& key) {
  return required(vector3_if(key), where(key), "3 numbers");
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> result;
  const toml::node* node = impl_->find(key);
  if (node == nullptr) return result;
  const toml::array* list = node->as_array();
  require(list != nullptr && list->is_homogeneous(toml::node_type::table),
          where(key),
          ": expected tables, each headed [[",
          key,
          "]]");
  for (const toml::node& entry : *list) {
    auto impl = std::make_unique<Impl>();
    impl->root = impl_->root;
    impl->table = entry.as_table();
    impl->file = impl_->file;
    impl->name = key + "[" + std::to_string(result.size()) + "]";
    result.push_back(TomlTable(std::move(impl)));
  }
  return result;
}

std::optional<TomlTable> TomlTable::table_if(const std::string& key) {
  const toml::node* node = impl_->find(key);
  if (node == nullptr) return std::nullopt;
  require(node->is_table(), where(key), ": expected a table headed [", key, "]");
  auto impl = std::make_unique<Impl>();
  impl->root = impl_->root;
  impl->table = node->as_table();
  impl->file = impl_->file;
  impl->name = impl_->name.empty() ? key : impl_->name + "." + key;
  return TomlTable(std::move(impl));
}

TomlTable TomlTable::table(const std::string& key) {
  std::optional<TomlTable> found = table_if(key);
  require(found.has_value(), where(key), ": missing; expected a table headed [", key, "]");
  return std::move(*found);
}

RigidTransform TomlTable::pose() {
  constexpr double kFarthest = 1e6;  // [m]
  RigidTransform result;
  require(!has("rotation") || !has("quaternion_xyzw"),
          where("rotation"),
          ": stands beside quaternion_xyzw; drop one of the two");
  if (has("rotation")) {
    const std::vector<double> r = numbers("rotation");
    require(r.size() == 9, where("rotation"), ": expected 9 numbers, got ", r.size());
    result = RigidTransform::from_rotation(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data()));
  } else if (has("quaternion_xyzw")) {
    const std::vector<double> q = numbers("quaternion_xyzw");
    require(q.size() == 4, where("quaternion_xyzw"), ": expected 4 numbers, got ", q.size());
    const Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
    require(std::abs(quaternion.norm() - 1) < 1e-3,
            where("quaternion_xyzw"),
            ": expected a quaternion of length 1, got length ",
            quaternion.norm());
    result.rotation = quaternion.normalized();
  }
  impl_->asked.insert({"rotation", "quaternion_xyzw"});
  result.translation = 1e-3 * vector3_if("translation_mm").value_or(Eigen::Vector3d::Zero().eval());
  require(result.translation.cwiseAbs().maxCoeff() < kFarthest,
          where("translation_mm"),
          ": expected lengths below 1e9 mm, got one of ",
          1e3 * result.translation.cwiseAbs().maxCoeff());
  return result;
}

void TomlTable::finish() const {
  for (const auto& [key, node] : *impl_->table) {
    const std::string name(key.str());
    if (impl_->asked.count(name) > 0) continue;
    const std::string near =
        nearest_name(name, std::vector<std::string>(impl_->asked.begin(), impl_->asked.end()));
    fail(where(name), ": unknown key", near.empty() ? "" : "; did you mean '" + near + "'?");
  }
}

}  // namespace facula
