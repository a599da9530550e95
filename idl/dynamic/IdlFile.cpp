#include <rabit/dynamic/IdlFile.h>

#include "dynamic/IdlIncludes.h"
#include "dynamic/ReadType.h"
#include "dynamic/ShapeBuilder.h"
#include "model/IdlTextEmitter.h"
#include "model/Names.h"
#include "model/SourceComments.h"
#include "model/SourceScan.h"

#include <nlohmann/json.hpp>

namespace Rabit
{
namespace
{

std::string Joined(const std::vector<std::string> &lines)
{
    std::string text;
    for (const std::string &line : lines)
    {
        text += (text.empty() ? "" : "\n") + line;
    }
    return text;
}

std::string JsonOf(const RabitIdl::Literal &value)
{
    return std::visit(
        [](const auto &one)
        {
            using T = std::decay_t<decltype(one)>;
            if constexpr (std::is_same_v<T, RabitIdl::EnumeratorValue>)
            {
                return nlohmann::json(one.Enum->Enumerators[one.Index].Name).dump();
            }
            else if constexpr (std::is_same_v<T, char>)
            {
                return nlohmann::json(std::string(1, one)).dump();
            }
            else
            {
                return nlohmann::json(one).dump();
            }
        },
        value);
}

void Take(const RabitIdl::Model &model, IdlFile &loaded)
{
    std::map<std::string, RabitIdl::SourceComments> files;
    const auto comment = [&](const std::string &name, const std::string &file, std::uint32_t line)
    {
        const auto found = files.try_emplace(file, file).first;
        if (const auto lines = found->second.About(line); !lines.empty())
        {
            loaded.Comments[name] = Joined(lines);
        }
    };
    for (const auto &definition : model.Definitions)
    {
        const std::string name = RabitIdl::ScopedName(definition->Scope, definition->Name);
        comment(name, definition->File, definition->Line);
        if (const auto *constant = dynamic_cast<const RabitIdl::ConstDefinition *>(definition.get()))
        {
            loaded.Constants.emplace_back(name, JsonOf(constant->Value));
        }
        const auto *structure = dynamic_cast<const RabitIdl::StructDefinition *>(definition.get());
        if (structure == nullptr)
        {
            continue;
        }
        for (const RabitIdl::Member *member : RabitIdl::AllMembers(*structure))
        {
            if (member->Line != definition->Line)
            {
                comment(name + "." + member->Name, member->File, member->Line);
            }
        }
        if (RabitIdl::IsMessage(*structure))
        {
            loaded.Messages.push_back(std::make_shared<const DynamicType>(
                name, RabitIdl::EmitIdlText(model, *structure), Dynamic::ShapeBuilder(model).Build(name)));
        }
    }
}

}  // namespace

IdlFile IdlFile::Load(const std::string &path, const std::vector<std::string> &folders)
{
    IdlFile loaded;
    try
    {
        const Dynamic::IncludedText text = Dynamic::WithIncludes(path, folders);
        RabitIdl::Refusals refusals;
        RefuseWhatIdlcMisreads(text.Paths, refusals);
        loaded.Reason = refusals.Empty() ? Dynamic::ReadModel(text.Text, true,
                                                              [&loaded](const RabitIdl::Model &model)
                                                              { Take(model, loaded); })
                                         : refusals.First();
    }
    catch (const Dynamic::Refused &refused)
    {
        loaded.Reason = refused.what();
    }
    return loaded;
}

}  // namespace Rabit
