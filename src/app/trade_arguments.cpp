#include "evert/app/trade_command.hpp"
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace evert {
namespace {

/// Without dashes; empty for what is no option.
std::string option_of(const std::string& argument) {
  if (argument.size() < 2 || argument[0] != '-' || std::isdigit(static_cast<unsigned char>(argument[1])) != 0)
    return "";
  return argument.substr(argument[1] == '-' ? 2 : 1);
}

std::vector<std::string> options_of(const std::string& command) {
  std::vector<std::string> options{"vary", "reference", "probe", "out", "limit", "samples"};
  if (command == "trade") options.emplace_back("repeat");
  if (command == "tune") options.insert(options.end(), {"error", "budget"});
  return options;
}

template <class Number>
Number number_of(const std::string& option, const std::string& text, Number least) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !(number >= least))
    throw UserError("-" + option + ": must be a number of at least " +
                    formatted("%g", static_cast<double>(least)) + ", not '" + text + "'");
  return number;
}

void take(TradeArguments& arguments, const std::string& option, const std::string& value) {
  if (option == "vary") arguments.variations.push_back(trade::parse_variation(value));
  if (option == "reference") arguments.reference.push_back(value);
  if (option == "probe") arguments.probes.push_back(value);
  if (option == "out") arguments.out = value;
  if (option == "repeat") arguments.repeat = number_of(option, value, 1);
  if (option == "limit") arguments.limit = number_of(option, value, 0.0);
  if (option == "samples") arguments.samples.fields = number_of(option, value, 2);
  if (option == "error") arguments.goal.error = trade::parse_share(option, value);
  if (option == "budget") arguments.goal.budget = trade::parse_share(option, value);
}

/// PETSc's options pass; a misspelt one of ours does not look like one of them.
void refuse_misspelt(const std::string& command, const std::string& option,
                     const std::vector<std::string>& known) {
  const auto match = nearest_match(option, known);
  if (!match.empty() && option.find('_') == std::string::npos && option != "set")
    throw UserError("evert " + command + ": there is no option -" + option + " (did you mean '-" + match +
                    "'?)");
}

void check_goal(const TradeArguments& arguments) {
  if (arguments.goal.error.has_value() == arguments.goal.budget.has_value())
    throw UserError("evert tune needs either -error, like 1%, or -budget, in CPU s per simulated s");
}

void check_axes(const TradeArguments& arguments) {
  std::vector<std::string> keys;
  for (const auto& variation : arguments.variations) {
    if (std::ranges::find(keys, variation.key) != keys.end())
      throw UserError("-vary " + variation.key + ": is given twice");
    keys.push_back(variation.key);
  }
}

}  // namespace

TradeArguments parse_trade_arguments(std::span<const std::string> arguments, const std::string& command) {
  TradeArguments parsed;
  parsed.help = asks_for_help(arguments);
  if (parsed.help) return parsed;
  const auto known = options_of(command);
  std::vector<std::string> of_run;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto option = option_of(arguments[i]);
    if (std::ranges::find(known, option) != known.end()) {
      if (i + 1 == arguments.size())
        throw UserError("-" + option + " needs a value: evert " + command + " -help shows which");
      take(parsed, option, arguments[++i]);
      continue;
    }
    if (!option.empty()) refuse_misspelt(command, option, known);
    of_run.push_back(arguments[i]);
    if (option == "set" && i + 1 < arguments.size()) of_run.push_back(arguments[++i]);
  }
  parsed.run = parse_run_arguments(of_run, command);
  if (!parsed.run.output.empty())
    throw UserError("-output is of evert run: what evert " + command + " writes goes to -out DIRECTORY");
  if (!parsed.run.restart.empty())
    throw UserError("-restart is of evert run: settings are compared from t = 0");
  check_axes(parsed);
  if (command == "tune") check_goal(parsed);
  return parsed;
}

std::string trade_usage() {
  return R"(evert trade SCENE.yaml [options]: what settings cost, how wrong they are, and which are worth it

  -vary key=value,value      an axis of the grid of settings, repeatable; e.g.
       -vary integrator.time_step=1e-4,2e-4       -vary bodies.*.mesh.edge_length=x1,x1.5
       -vary petsc.damping_ksp_rtol=1e-2,1e-6     -vary bodies.*.mesh.element=tet4,tet10,hex8
                             * stands for every body that has such a key, x1.5 for 1.5 times what the scene has.
                             Without it: steps, tolerances and meshes, as the scene has them
  -reference key=value       what the reference has besides the best values of all axes; repeatable
  -probe name=x,y,z          a point [m] at rest that is followed; of one body: name=body:x,y,z; repeatable
  -out directory             instead of trade_<name of the scene>; a run that is in there is not made again
  -repeat 2                  how often each setting is timed, one round of all after the other
  -limit seconds             of processor time that one run may take on a rank
  -samples 40                at how many times fields are compared
  -set key=value             override a value of the scene for all settings; repeatable
  -quiet                     no line for each run
  Solver options             as in evert run

The reference has the best value of each axis, refined twice; what it is wrong by is estimated from how the refinements
differ. Errors are RMS differences of the displacement over mass and time, relative to the RMS displacement. Costs are
seconds of the processor per simulated second. Writes trade.csv, trade.svg and the scenes front_1.yaml, front_2.yaml, ...
)";
}

std::string tune_usage() {
  return R"(evert tune SCENE.yaml -error 1% | -budget 0.5 [options]: the setting to take, from few runs

  -error 1%                  find the cheapest setting that is not more wrong than that
  -budget 0.5                find the most accurate setting that costs no more CPU s per simulated s
  -vary, -reference, -probe, -out, -limit, -samples, -set, -quiet   as in evert trade

Runs the reference, each axis by itself, and then what promises most: at most a quarter of the runs of evert trade where its
grid is large. Says which setting buys most, prints the command of the chosen one and writes it as tuned.yaml.
)";
}

}  // namespace evert
