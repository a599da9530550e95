// Turns idlc's syntax tree into a Model, and refuses what the generator does not support.
#pragma once

#include "IdlTree.h"
#include "Model.h"
#include "Refusals.h"

#include <map>
#include <set>

namespace RabitIdl
{

class ModelReader
{
public:
    // state: idlc's const idl_pstate_t *.
    ModelReader(const void *state, Refusals &refusals) : _state(state), _refusals(refusals) {}
    // The model is usable only if nothing was refused.
    Model Read();

private:
    void ReadFiles();
    void ReadDefinitions(TreeNode first);
    void ReadStruct(TreeNode node);
    void ReadUnion(TreeNode node);
    void ReadEnum(TreeNode node);
    void ReadBitmask(TreeNode node);
    void ReadTypedef(TreeNode node);
    void ReadConst(TreeNode node);
    void ReadMembers(TreeNode structure, StructDefinition &definition);
    Type ReadType(TreeNode spec, TreeNode place);
    Type ReadDeclaredType(TreeNode spec, TreeNode declarator);
    Literal ReadLiteral(TreeNode value);

    void CheckName(TreeNode node, const std::string &name);
    void CheckTypeName(TreeNode node, const std::string &name);
    void CheckMemberNames(TreeNode node, const StructDefinition &definition);
    void CheckAnnotations(TreeNode node);
    void CheckIds(TreeNode structure, const StructDefinition &definition);
    void CheckExtensibility(TreeNode node);
    void CheckKey(TreeNode place, const Type &type);
    void CheckDefault(TreeNode place, const Member &member);

    void Refuse(TreeNode place, const std::string &message);
    template <class T>
    std::unique_ptr<T> Begin(TreeNode node);
    void Finish(TreeNode node, std::unique_ptr<Definition> definition);

    const void *_state;
    Refusals &_refusals;
    Model _model;
    std::vector<std::string> _scope;
    std::map<TreeNode, const Definition *> _known;                                    // by type node
    std::map<TreeNode, std::pair<const EnumDefinition *, std::size_t>> _enumerators;  // by enumerator node
};

}  // namespace RabitIdl
