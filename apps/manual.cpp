#include "apps/manual.hpp"

#include <sstream>
#include <vector>

namespace hopscotch::apps {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  std::vector<const CLI::App*> shown;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty()) shown.push_back(command);  // an empty group hides
  }
  return shown;
}

/// Text as troff takes it: a backslash, a leading dot and a minus sign mean something there.
std::string troff(const std::string& text) {
  std::string result;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
    line_begins = c == '\n';
  }
  return result;
}

/// "--seed UINT", or the plain name of a positional argument.
std::string usage_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true, false);
  std::string text = option.get_name(false, true);
  if (option.get_items_expected_max() > 0) {
    const std::string type = option.get_type_name();
    text += " " + type.substr(0, type.find(':'));
  }
  return text;
}

void describe(const CLI::App& command, std::ostringstream& page) {
  page << ".SS hopscotch " << troff(command.get_name()) << "\n"
       << troff(command.get_description()) << ".\n";
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    page << ".TP\n.B " << troff(usage_of(*option)) << "\n" << troff(option->get_description());
    if (!option->get_default_str().empty() && !option->get_positional()) {
      page << " [" << troff(option->get_default_str()) << "]";
    }
    page << "\n";
  }
  if (!command.get_footer().empty())
    page << ".PP\n.nf\n" << troff(command.get_footer()) << "\n.fi\n";
}

std::string words_of(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) words += " --" + name;
  }
  return words;
}

}  // namespace

std::string man_page(const CLI::App& app, std::string_view version) {
  std::ostringstream page;
  page << ".TH HOPSCOTCH 1 \"\" \"hopscotch " << version << "\" \"User Commands\"\n"
       << ".SH NAME\nhopscotch \\- continuous bipedal jumping over terrain that the robot sees\n"
       << ".SH SYNOPSIS\n.B hopscotch\n.I COMMAND\n[OPTIONS]\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) describe(*command, page);
  page
      << ".SH EXIT STATUS\n"
         ".TP\n.B 0\nIt did what was asked.\n"
         ".TP\n.B 1\nIt ran, and the answer is no: the robot fell, the target was refused, a bound "
         "was missed, nobody answered.\n"
         ".TP\n.B 2\nBad usage or bad input; the message names file, line, key, value and rule.\n"
         ".TP\n.B 3\nThe machine lacks something: a device, a right, a package.\n"
         ".SH ENVIRONMENT\n.TP\n.B LCM_DEFAULT_URL\nAddress of the live channels; without it they "
         "stay on this machine.\n"
         ".SH FILES\nA run folder holds result.json, run.lcm, config.yaml, robot.yaml, scene.xml, "
         "report.html and on request video.mp4; after a fall or fault also black\\-box/, a run "
         "folder with the last 20 s.\n";
  return page.str();
}

std::string bash_completion(const CLI::App& app) {
  std::ostringstream script;
  std::string names;
  for (const CLI::App* command : commands_of(app)) names += " " + command->get_name();
  script
      << "# bash completion for hopscotch; for zsh: autoload bashcompinit && bashcompinit first\n"
      << "_hopscotch() {\n"
      << "  local word=${COMP_WORDS[COMP_CWORD]} words=\n"
      << "  COMPREPLY=()\n"
      << "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      << "    words='" << names.substr(1) << " --help --version'\n"
      << "  else\n"
      << "    case ${COMP_WORDS[1]} in\n";
  for (const CLI::App* command : commands_of(app)) {
    std::string words = words_of(*command);
    if (command->get_name() == "command") words += " enable jump hold stop damp clear-fault";
    if (command->get_name() == "bench") words += " planner mpc perception estimator sim tick";
    script << "      " << command->get_name() << ") words='" << words.substr(1) << "' ;;\n";
  }
  script << "    esac\n"
         << "  fi\n"
         << "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         << "  case $word in -*) ;; *) [ \"$COMP_CWORD\" -gt 1 ] && COMPREPLY+=($(compgen -f -- "
            "\"$word\")) ;; esac\n"
         << "}\n"
         << "complete -o filenames -F _hopscotch hopscotch\n";
  return script.str();
}

}  // namespace hopscotch::apps
