// The program `broadside-mpi`, started by mpirun: the verb `pairs` on the ranks of an MPI job.
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <mpi.h>

#include "broadside/version.hpp"

#include "cli/help.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/mpi/pairs.hpp"
#include "cli/mpi/ranks.hpp"
#include "cli/parse.hpp"
#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"
#include "lab/platform/terminal.hpp"

namespace broadside::cli {
namespace {

/// All ranks have the same arguments and refuse the same ones. Only one rank prints help and version.
Exit run(const std::vector<std::string>& arguments) {
  const lab::Catalogue catalogue;
  CLI::App program(
      "Finds overlapping boxes by the ranks of an MPI job: mpirun -n 4 broadside-mpi pairs boxes.npy -o "
      "pairs.npy.",
      program_name());
  program.formatter(std::make_shared<HelpFormatter>());
  program.set_help_flag("-h,--help", "Print this help and end");
  program.set_version_flag("--version", "broadside-mpi " BROADSIDE_VERSION, "Print the version and end");
  program.require_subcommand(1);
  program.footer(
      "Exit status: 0 fine, 2 unusable arguments or input, 130 interrupted; mpirun ends all ranks where one "
      "is "
      "killed, and has a status of its own then.");
  const Verb pairs = add_mpi_pairs(program, catalogue);
  std::optional<std::string> text;
  on_all([&] {
    text = parse(program, without_help_verb(arguments));
    if (text && rank() == 0) print(*text);
  });
  return text ? Exit::success : pairs();
}

}  // namespace
}  // namespace broadside::cli

int main(int count, char** values) {
  using namespace broadside;
  lab::platform::prepare_standard_streams();
  // A rank searches with several threads, but calls MPI from its first thread only.
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&count, &values, MPI_THREAD_FUNNELED, &provided);
  cli::set_program_name("broadside-mpi");
  if (provided < MPI_THREAD_FUNNELED) {
    cli::say("this MPI library provides MPI_THREAD_SINGLE; expected MPI_THREAD_FUNNELED or more");
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(cli::Exit::usage_error));
  }
  // Only this rank writes files; mpirun ends the other ranks with it.
  if (cli::rank() == 0) cli::on_signal(cli::OnSignal::end);
  cli::Exit exit = cli::Exit::usage_error;
  try {
    exit = cli::run(lab::platform::arguments(count, values));
    cli::flush_output();
  } catch (const cli::SharedError& error) {
    if (cli::rank() == 0) cli::say(error.what());
  } catch (const std::exception& error) {
    // The other ranks do not know of the error and may be waiting for this rank.
    cli::say(fmt::format("rank {}: {}", cli::rank(), error.what()));
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(cli::Exit::usage_error));
  }
  const bool is_first = cli::rank() == 0;
  MPI_Finalize();
  // mpirun passes on one rank's status, and sends the others a signal.
  return is_first ? static_cast<int>(exit) : 0;
}
