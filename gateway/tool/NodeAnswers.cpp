#include "NodeAnswers.h"

#include <utility>

namespace Rabit::Tool
{

NodeAnswers AnswersOfAll(FleetSession &session, FleetExplorer::Report what, double until)
{
    FleetExplorer &explorer = session.Explorer();
    NodeAnswers answers;
    for (const FleetSession::Node &node : session.Nodes())
    {
        if (node.State != Gateway::NodeState::LOST)
        {
            explorer.AskForReport(node.Name, what);
            answers.emplace(node.Name, std::nullopt);
        }
    }
    session.WaitUntil(until,
                      [&]
                      {
                          bool all = true;
                          for (auto &[name, text] : answers)
                          {
                              if (!text)
                              {
                                  auto answer = explorer.TakeReport(name, what);
                                  text = answer ? std::optional(std::move(answer->Text)) : std::nullopt;
                              }
                              all = all && text.has_value();
                          }
                          return all;
                      });
    return answers;
}

}  // namespace Rabit::Tool
