#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/json/json_text.h"
#include "jobs/queue/database.h"
#include "jobs/spec/described_json.h"

namespace lacuna {

/// Visitors of describe(): the columns of a table are the members of the struct of its rows.
/// Integers, bools, enums (by name) and texts are stored as such, lists and structs as JSON, empty
/// optionals as NULL.

/// names: "a","b","c" in quotes; places: ?,?,?.
class ColumnNames {
 public:
  template <class T>
  void operator()(std::string_view name, T&, const Field&) {
    const std::string comma = names.empty() ? "" : ",";
    names += comma + '"' + std::string(name) + '"';
    places += comma + "?";
  }
  std::string names, places;
};

template <class Row>
const ColumnNames& columns() {
  static const ColumnNames made = [] {
    ColumnNames names;
    Row row;
    describe(names, row);
    return names;
  }();
  return made;
}

/// Binds each member as the next parameter.
class ColumnBinder {
 public:
  explicit ColumnBinder(Statement& query) : query_(query) {}
  template <class T>
  void operator()(std::string_view, T& value, const Field&) {
    bind(value);
  }

 private:
  template <class T>
  void bind(const T& value) {
    if constexpr (is_optional<T>) {
      if (value) {
        bind(*value);
      } else {
        query_.bind_null();
      }
    } else if constexpr (std::is_integral_v<T>) {
      query_.bind(static_cast<std::int64_t>(value));
    } else if constexpr (NamedEnum<T>) {
      query_.bind(enum_name(value));
    } else if constexpr (Described<T>) {
      query_.bind(json_text(ObjectWriter::value_of(value)));
    } else if constexpr (is_vector<T>) {
      query_.bind(json_text(OrderedJson(value)));
    } else {
      query_.bind(std::string_view(value));
    }
  }
  Statement& query_;
};

/// Reads each member from the next column. Throws DatabaseDamaged for invalid values.
class ColumnReader {
 public:
  explicit ColumnReader(const Statement& query) : query_(query) {}
  template <class T>
  void operator()(std::string_view name, T& value, const Field&) {
    try {
      read(value);
    } catch (const std::exception& error) {
      throw DatabaseDamaged(std::string(name) + ": " + error.what());
    }
    ++column_;
  }

 private:
  template <class T>
  void read(T& value) const {
    if constexpr (is_optional<T>) {
      value.reset();
      if (!query_.is_null(column_)) read(value.emplace());
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(query_.integer(column_));
    } else if constexpr (NamedEnum<T>) {
      const std::string name = query_.text(column_);
      for (const auto& known : EnumTable<T>::values) {
        if (known.name == name) return void(value = known.value);
      }
      throw std::runtime_error("found \"" + name + "\"");
    } else if constexpr (Described<T>) {
      value = read_document<T>(query_.text(column_), {1 << 20, 8});
    } else if constexpr (is_vector<T>) {
      value = parse_own(query_.text(column_)).template get<T>();
    } else {
      value = query_.text(column_);
    }
  }
  const Statement& query_;
  int column_ = 0;
};

template <class Row>
void bind_row(Statement& query, Row& row) {
  ColumnBinder binder(query);
  describe(binder, row);
}

template <class Row>
Row read_row(const Statement& query) {
  Row row;
  ColumnReader reader(query);
  describe(reader, row);
  return row;
}

}  // namespace lacuna
