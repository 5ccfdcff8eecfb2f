#include "evert/core/error.hpp"
#include "evert/core/schema.hpp"

#include <gtest/gtest.h>

/// The tables themselves, without YAML and without scenes.
namespace evert::schema {
namespace {

Value scalar(const std::string& text) {
  return {.kind = Value::Kind::scalar, .where = "here:1", .text = text};
}

Value map(std::vector<std::pair<std::string, Value>> entries) {
  return {.kind = Value::Kind::map, .where = "here:1", .entries = std::move(entries)};
}

template <class Read>
std::string complaint(Read read) {
  try {
    static_cast<void>(read());
    return "nothing";
  } catch (const UserError& error) {
    return error.what();
  }
}

struct Circle {
  double radius = 0;
};
struct Square {
  double side = 0;
};
struct Plate {
  std::variant<Circle, Square> shape;
  double thickness = 0.5;
  std::optional<double> hole;
};

const Table<Circle>& circle_table() {
  static const auto table =
      Table<Circle>("A circle.")
          .required("radius", &Circle::radius, number("m", above(0)), "1", "Half the width.");
  return table;
}

const Table<Square>& square_table() {
  static const auto table =
      Table<Square>("A square.").required("side", &Square::side, number("m", above(0)), "1", "The width.");
  return table;
}

const Table<Plate>& plate_table() {
  static const auto table =
      Table<Plate>("A plate.")
          .chosen_by("shape", "Its outline.")
          .alternative("circle", &Plate::shape, circle_table())
          .alternative("square", &Plate::shape, square_table())
          .optional("thickness", &Plate::thickness, number("m", at_least(0)), "1", "How thick.")
          .optional("hole", &Plate::hole, number("m", between(0, 1)), "0.1", "Radius of a hole.")
          .then([](Plate& plate, const Value& values, const std::string& path) {
            if (plate.hole && *plate.hole > 0.9) fail(values, path, "has too large a hole");
          });
  return table;
}

TEST(Ranges, contain_what_their_text_says) {
  EXPECT_TRUE(at_least(0).contains(0));
  EXPECT_FALSE(above(0).contains(0));
  EXPECT_FALSE(between(-1, 0.5).contains(0.5));
  EXPECT_FALSE(between(-1, 0.5).contains(-1));
  EXPECT_TRUE(above_up_to(0, 1).contains(1));
  EXPECT_FALSE(above_up_to(0, 1).contains(0));
  EXPECT_TRUE(any_number().contains(-1e300));
  EXPECT_EQ(at_least(0).text(), ">= 0");
  EXPECT_EQ(above(0).text(), "> 0");
  EXPECT_EQ(between(-1, 0.5).text(), "in (-1, 0.5)");
  EXPECT_EQ(above_up_to(0, 1).text(), "in (0, 1]");
  EXPECT_EQ(any_number().text(), "");
}

TEST(Numbers, are_read_to_the_last_bit) {
  for (const auto* text :
       {"1.7976931348623157e308", "-2.2250738585072014e-308", "0.1", "5", "+5", ".5", "5.", "1E3"})
    EXPECT_EQ(number("m").read(scalar(text), "x"), std::stod(text)) << text;
}

TEST(Numbers, are_nothing_else) {
  for (const auto* text :
       {"", "one", "1 2", "1..2", "--1", "0x10", "1e", "+-1", "1_000", "true", "-", "+", "1e5m"})
    EXPECT_NE(complaint([&] { return number("m").read(scalar(text), "x"); }), "nothing") << text;
}

TEST(Tables, read_the_chosen_alternative) {
  const auto plate = plate_table().read(
      map({{"shape", scalar("square")}, {"side", scalar("3")}, {"hole", scalar("0.2")}}), "plate");
  EXPECT_EQ(std::get<Square>(plate.shape).side, 3);
  EXPECT_EQ(plate.thickness, 0.5);
  EXPECT_EQ(plate.hole, 0.2);
}

TEST(Tables, complain_about_keys) {
  const auto read = [](std::vector<std::pair<std::string, Value>> entries) {
    return complaint([&] { return plate_table().read(map(std::move(entries)), "plate"); });
  };
  EXPECT_EQ(read({{"shape", scalar("circle")}}), "here:1: plate: 'radius' is missing [m], e.g. radius: 1");
  EXPECT_EQ(read({{"shape", scalar("circle")}, {"radius", scalar("1")}, {"side", scalar("1")}}),
            "here:1: plate.side: does not go with 'shape: circle'; known there are shape, radius, thickness "
            "or hole");
  EXPECT_EQ(read({{"shape", scalar("circle")}, {"radius", scalar("1")}, {"hol", scalar("1")}}),
            "here:1: plate.hol: unknown key (did you mean 'hole'?)");
  EXPECT_EQ(read({{"radius", scalar("1")}}), "here:1: plate: needs one of 'shape: circle or shape: square'");
  EXPECT_EQ(read({{"shape", scalar("circle")}, {"radius", scalar("1")}, {"hole", scalar("0.95")}}),
            "here:1: plate: has too large a hole");
}

TEST(Tables, describe_themselves) {
  const auto& info = plate_table().info();
  EXPECT_EQ(info.key_names(), (std::vector<std::string>{"shape", "radius", "side", "thickness", "hole"}));
  EXPECT_EQ(info.find("thickness")->default_text, "0.5");
  EXPECT_EQ(info.find("hole")->default_text, "");
  EXPECT_EQ(info.find("side")->type.unit, "m");
  EXPECT_TRUE(info.find("side")->required);
  EXPECT_EQ(info.find("volume"), nullptr);
}

TEST(Values, keep_the_order_of_their_keys) {
  auto value = map({{"b", scalar("1")}, {"a", scalar("2")}});
  value.set("b", scalar("3"));
  value.set("c", scalar("4"));
  EXPECT_EQ(canonical_text(value), "{b: 3, a: 2, c: 4}");
  value.erase("a");
  EXPECT_EQ(canonical_text(value), "{b: 3, c: 4}");
  EXPECT_EQ(value.find("a"), nullptr);
}

TEST(Values, are_shown_in_one_short_line) {
  EXPECT_EQ(shown("a\nb\x01"), "'a\\nb\\x01'");
  EXPECT_EQ(shown(std::string(100, 'x')), "'" + std::string(60, 'x') + "...'");
}

}  // namespace
}  // namespace evert::schema
