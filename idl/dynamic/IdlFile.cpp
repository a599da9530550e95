#include <rabit/dynamic/IdlFile.h>

#include "dynamic/IdlIncludes.h"
#include "dynamic/ReadType.h"
#include "dynamic/ShapeBuilder.h"
#include "model/IdlTextEmitter.h"
#include "model/Names.h"

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
    const auto comment = [&loaded](const std::string &name, const std::vector<std::string> &lines)
    {
        if (!lines.empty())
        {
            loaded.Comments[name] = Joined(lines);
        }
    };
    for (const auto &definition : model.Definitions)
    {
        const std::string name = RabitIdl::ScopedName(definition->Scope, definition->Name);
        comment(name, definition->Comment);
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
            comment(name + "." + member->Name, member->Comment);
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
        loaded.Reason = Dynamic::ReadModel(Dynamic::WithIncludes(path, folders), true,
                                           [&loaded](const RabitIdl::Model &model) { Take(model, loaded); });
    }
    catch (const Dynamic::Refused &refused)
    {
        loaded.Reason = refused.what();
    }
    return loaded;
}

}  // namespace Rabit
