"""`mbint lsp` by a client that speaks the protocol (pytest-lsp). The variable MBINT names the command."""

import asyncio
import json
import os
import re
import shutil
from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

MODELS = Path(__file__).resolve().parents[2] / "models"

MODEL = """\
model: arm
parameters:
  length: { value: 0.5, unit: m, tolerance: 2% }
  half: length/2
  mass: 1.5 kg
bodies:
  arm: { mass: mass, inertia: mass*length^2/12, points: { hinge: [-half, 0], tip: [half, 0] } }
joints:
  hinge: { revolute: [ground, arm.hinge] }
effects:
  weight: { gravity: { acceleration: [0, -9.81 m/s^2] } }
  spring: { torsional_spring_damper: { between: [ground, arm], stiffness: 3 } }
outputs:
  height: arm.tip.y   # of the tip
  swing: hinge.angle
requirements:
  low: height <= 0.3 m
simulation: { duration: 0.1, step: 1e-3 }
"""

PART = """\
assemblies:
  finger:
    parameters: { reach: 0.1 m ± 1%, weight: 0.2 kg }
    bodies:
      bone: { mass: weight, inertia: 1e-4, points: { root: [-reach/2, 0], tip: [reach/2, 0] } }
    joints:
      knuckle: { revolute: [ground, bone.root] }
    ports: { end: bone.tip }
"""

HAND = """\
include: parts/finger.yaml
instances:
  left: { of: finger }
  right: { of: finger, parameters: { reach: 0.12 m } }
outputs:
  left: left.bone.tip.x
  apart: right.end.x - left.end.x
  bend: left.knuckle.angle
simulation: { duration: 0.1, step: 1e-3 }
"""


@pytest_lsp.fixture(config=ClientServerConfig(server_command=[os.environ.get("MBINT", "mbint"), "lsp"]))
async def client(lsp_client: LanguageClient, tmp_path_factory: pytest.TempPathFactory):
    folder = tmp_path_factory.mktemp("workspace")
    lsp_client.folder = folder
    await lsp_client.initialize_session(
        lsp.InitializeParams(
            capabilities=client_capabilities("visual-studio-code"),
            workspace_folders=[lsp.WorkspaceFolder(uri=folder.as_uri(), name="models")],
        )
    )
    yield
    await lsp_client.shutdown_session()


class Editor:
    """A document in the client, with positions given by their text."""

    def __init__(self, client: LanguageClient, name: str, text: str) -> None:
        self.client, self.text, self.version = client, text, 1
        self.path = client.folder / name
        self.path.parent.mkdir(exist_ok=True)
        self.uri = self.path.as_uri()
        self.identifier = lsp.TextDocumentIdentifier(uri=self.uri)
        item = lsp.TextDocumentItem(uri=self.uri, language_id="yaml", version=1, text=text)
        client.text_document_did_open(lsp.DidOpenTextDocumentParams(text_document=item))

    def at(self, place: str) -> dict:
        """Position of the `|` of a piece of the text."""
        before = place.index("|")
        offset = self.text.index(place.replace("|", "")) + before
        lines = self.text[:offset].split("\n")
        position = lsp.Position(line=len(lines) - 1, character=len(lines[-1]))
        return {"text_document": self.identifier, "position": position}

    def change(self, old: str, new: str) -> None:
        """Types over a piece of the text."""
        place, self.version = self.at("|" + old)["position"], self.version + 1
        end = lsp.Position(line=place.line, character=place.character + len(old))
        change = lsp.TextDocumentContentChangePartial(range=lsp.Range(start=place, end=end), text=new)
        versioned = lsp.VersionedTextDocumentIdentifier(uri=self.uri, version=self.version)
        self.client.text_document_did_change(lsp.DidChangeTextDocumentParams(versioned, [change]))
        self.text = self.text.replace(old, new, 1)

    async def diagnostics(self, until=bool, tries: int = 100) -> list[lsp.Diagnostic]:
        """Diagnostics of the document, as soon as `until` accepts them."""
        for _ in range(tries):
            found = self.client.diagnostics.get(self.uri, [])
            if until(found):
                return list(found)
            await asyncio.sleep(0.05)
        raise AssertionError(f"diagnostics are {self.client.diagnostics.get(self.uri)}")

    def text_in(self, span: lsp.Range) -> str:
        lines = self.text.split("\n")
        assert span.start.line == span.end.line
        return lines[span.start.line][span.start.character : span.end.character]

    async def completions(self, place: str) -> dict[str, lsp.CompletionItem]:
        found = await self.client.text_document_completion_async(lsp.CompletionParams(**self.at(place)))
        return {item.label: item for item in found.items}

    async def hover(self, place: str) -> str:
        found = await self.client.text_document_hover_async(lsp.HoverParams(**self.at(place)))
        return found.contents.value if found else ""

    async def references(self, place: str) -> list[lsp.Location]:
        context = lsp.ReferenceContext(include_declaration=True)
        return await self.client.text_document_references_async(lsp.ReferenceParams(context=context, **self.at(place)))

    async def rename(self, place: str, new: str) -> dict[str, str]:
        """Texts of the files, by address, with the changes."""
        edit = await self.client.text_document_rename_async(lsp.RenameParams(new_name=new, **self.at(place)))
        return {uri: applied(uri, self, edits) for uri, edits in edit.changes.items()}


def applied(uri: str, editor: Editor, edits: list[lsp.TextEdit]) -> str:
    text = editor.text if uri == editor.uri else Path(uri.removeprefix("file://")).read_text()
    lines = text.split("\n")
    for edit in sorted(edits, key=lambda own: (own.range.start.line, own.range.start.character), reverse=True):
        start, end = edit.range.start, edit.range.end
        rest = lines[end.line][end.character :]
        lines[start.line : end.line + 1] = (lines[start.line][: start.character] + edit.new_text + rest).split("\n")
    return "\n".join(lines)


@pytest.mark.asyncio
async def test_an_error_appears_while_typing_with_its_cure(client: LanguageClient) -> None:
    editor = Editor(client, "arm.yaml", MODEL)
    assert await editor.diagnostics(lambda found: editor.uri in client.diagnostics) == []
    editor.change("mass: mass,", "mass: mas,")
    [wrong] = await editor.diagnostics()
    assert editor.text_in(wrong.range) == "mas" and "did you mean `mass`?" in wrong.message
    assert wrong.severity == lsp.DiagnosticSeverity.Error
    assert wrong.code == "E0401" and wrong.code_description.href.endswith("/docs/errors/E0401.md")
    params = lsp.CodeActionParams(editor.identifier, wrong.range, lsp.CodeActionContext(diagnostics=[wrong]))
    [action] = await client.text_document_code_action_async(params)
    [edit] = action.edit.changes[editor.uri]
    assert (edit.new_text, edit.range) == ("mass", wrong.range) and action.kind == lsp.CodeActionKind.QuickFix
    editor.change("mass: mas,", "mass: mass,")
    await editor.diagnostics(lambda found: not found)


@pytest.mark.asyncio
async def test_an_error_of_the_mechanism_appears_as_check_prints_it(client: LanguageClient) -> None:
    held = MODEL.replace("arm.hinge] }\n", "arm.hinge] }\n  other: { revolute: [ground, arm.tip] }\n", 1)
    editor = Editor(
        client, "held.yaml", held.replace("points: {", "points: { far: [9, 9],", 1).replace("arm.tip]", "arm.far]")
    )
    command = [os.environ.get("MBINT", "mbint"), "check", "--format", "json", "-"]
    process = await asyncio.create_subprocess_exec(*command, stdin=-1, stdout=-1, stderr=-1)
    printed, _ = await process.communicate(editor.text.encode())
    [checked] = json.loads(printed)
    assert checked["error"]
    [found] = await editor.diagnostics()
    assert found.message == checked["error"] and found.range.start.line == 0


@pytest.mark.asyncio
async def test_keys_names_members_units_functions_and_elements_are_completed(client: LanguageClient) -> None:
    editor = Editor(client, "complete.yaml", MODEL)
    await editor.diagnostics(lambda found: editor.uri in client.diagnostics)
    keys = await editor.completions("mass: mass, |inertia")
    assert "center_of_mass" in keys and "mass" not in keys and "inertia" in keys["inertia"].text_edit.new_text
    assert "statistics" in set(await editor.completions("|simulation:"))
    names = await editor.completions("inertia: |mass*")
    assert names["length"].detail == "0.5 m, from 0.49 to 0.51 m"
    assert {"sin", "atan2", "t", "arm", "hinge", "half"} <= set(names)
    members = await editor.completions("height: arm.|tip.y")
    assert members["vx"].detail == "m/s" and members["tip"].kind == lsp.CompletionItemKind.Field
    assert members["vx"].text_edit.new_text == "arm.vx"
    assert (await editor.completions("arm.tip.|y"))["ay"].detail == "m/s^2"
    assert (await editor.completions("swing: hinge.|angle"))["angular_velocity"].detail == "rad/s"
    points = await editor.completions("[ground, |arm.hinge]")
    assert {"arm", "arm.tip", "ground"} <= set(points)
    units = await editor.completions("<= 0.3 |m")
    assert "mm" in units and "height" in await editor.completions("low: |height")
    units = await editor.completions("-9.81 |m/s^2")
    assert "kN" in units and "rpm" in units
    elements = await editor.completions("  |weight: { gravity")
    snippet = elements["spring_damper"]
    assert snippet.insert_text_format == lsp.InsertTextFormat.Snippet
    assert snippet.text_edit.new_text.startswith("${1:name}: { spring_damper: { between: [${2:")
    assert "analysis: s" and "statics" in await editor_of(client, "analysis: s\n").completions("analysis: s|")


def editor_of(client: LanguageClient, text: str) -> Editor:
    return Editor(client, f"text_{abs(hash(text))}.yaml", text)


@pytest.mark.asyncio
async def test_hover_has_documentation_unit_value_and_interval(client: LanguageClient) -> None:
    editor = Editor(client, "hover.yaml", MODEL)
    await editor.diagnostics(lambda found: editor.uri in client.diagnostics)
    length = await editor.hover("half: len|gth/2")
    assert "parameter **length**, m" in length and "0.5 m, from 0.49 to 0.51 m" in length
    assert "0.25 m, from 0.245 to 0.255 m" in length, "the formula around it"
    # 1.5*0.5^2/12, and with 0.49 and 0.51 in place of 0.5.
    whole = await editor.hover("mass*length^2|/12")
    inertia = [1.5 * length**2 / 12 for length in (0.5, 0.49, 0.51)]
    numbers = [float(number) for number in re.findall(r"\d+\.\d+(?:e-?\d+)?", whole)[:3]]
    assert numbers == pytest.approx(inertia, rel=1e-5) and "kg*m^2" in whole
    assert "velocity" not in await editor.hover("arm.tip.|y") and "along the ground's y, m" in await editor.hover(
        "arm.tip.|y"
    )
    assert "rest" not in await editor.hover("iner|tia:") and "kg*m^2" in await editor.hover("iner|tia:")
    assert "N*m" in await editor.hover("stiff|ness: 3") and "joint **hinge**" in await editor.hover("swing: hi|nge")
    spring = await editor.hover("torsional_spring|_damper")
    assert "```yaml" in spring and "stiffness" in spring
    assert await editor.hover("# of |the tip") == ""


@pytest.mark.asyncio
async def test_definitions_references_and_new_names(client: LanguageClient) -> None:
    editor = Editor(client, "names.yaml", MODEL)
    await editor.diagnostics(lambda found: editor.uri in client.diagnostics)
    [definition] = await client.text_document_definition_async(lsp.DefinitionParams(**editor.at("height: arm.ti|p.y")))
    assert editor.text_in(definition.range) == "tip" and definition.range.start.line == 6
    # The joint and the point of the same name are distinguished.
    assert [found.range.start.line for found in await editor.references("  hin|ge: {")] == [8, 14]
    assert [found.range.start.line for found in await editor.references("arm.hin|ge]")] == [6, 8]
    assert len(await editor.references("  len|gth: {")) == 3
    assert len(await editor.references("low: hei|ght")) == 2
    renamed = await editor.rename("low: hei|ght", "top")
    assert renamed[editor.uri] == MODEL.replace("height", "top")
    renamed = await editor.rename("[ground, ar|m.hinge]", "lever")
    assert renamed[editor.uri] == re.sub(r"\barm\b(?=[.:\]])", "lever", MODEL)
    for wrong, reason in [("two words", "cannot be a name"), ("half", "half"), ("t", "t")]:
        with pytest.raises(JsonRpcException, match=reason):
            await editor.rename("half: len|gth/2", wrong)


@pytest.mark.asyncio
async def test_includes_and_instances(client: LanguageClient) -> None:
    (client.folder / "parts").mkdir(exist_ok=True)
    (client.folder / "parts/finger.yaml").write_text(PART)
    (client.folder / "hand.yaml").write_text(HAND)
    hand = Editor(client, "hand.yaml", HAND)
    await hand.diagnostics(lambda found: hand.uri in client.diagnostics and not found)
    part_uri = (client.folder / "parts/finger.yaml").as_uri()
    [definition] = await client.text_document_definition_async(lsp.DefinitionParams(**hand.at("left.bo|ne.tip.x")))
    assert (definition.uri, definition.range.start.line) == (part_uri, 4)
    [definition] = await client.text_document_definition_async(lsp.DefinitionParams(**hand.at("right.en|d.x")))
    assert (definition.uri, definition.range.start.line) == (part_uri, 7)
    renamed = await hand.rename("left.bo|ne.tip.x", "phalanx")
    assert renamed == {
        hand.uri: HAND.replace("left.bone", "left.phalanx"),
        part_uri: PART.replace("bone", "phalanx"),
    }
    # In the included file, which is edited and not stored: its errors are its own, and those of the hand's instances.
    part = Editor(client, "parts/finger.yaml", PART)
    part.change("mass: weight", "mass: wieght")
    found = await part.diagnostics()
    assert len(found) == 1 and part.text_in(found[0].range) == "wieght" and "did you mean" in found[0].message
    assert any("instance of `finger`" in related.message for related in found[0].related_information)
    part.change("mass: wieght", "mass: weight")
    await part.diagnostics(lambda found: not found)
    assert "reach" in await part.completions("root: [-|reach/2")
    assert "0.1 m, from 0.099 to 0.101 m" in await part.hover("[-re|ach/2, 0]")
    assert "unknown" not in str(await hand.diagnostics(lambda found: not found))


@pytest.mark.asyncio
async def test_a_file_of_assemblies_alone_is_checked(client: LanguageClient) -> None:
    part = Editor(client, "lonely/finger.yaml", PART.replace("[ground, bone.root]", "[ground, bone.rot]"))
    [found] = await part.diagnostics()
    assert part.text_in(found.range) in ("rot", "bone.rot") and "root" in found.message


@pytest.mark.asyncio
async def test_files_out_of_the_models_folder_are_not_read(client: LanguageClient) -> None:
    secret = client.folder.parent / "secret.yaml"
    secret.write_text(PART)
    editor = Editor(client, "curious.yaml", HAND.replace("parts/finger.yaml", "../secret.yaml"))
    found = await editor.diagnostics()
    assert any("is not within the model's folder" in own.message for own in found)
    assert secret.as_uri() not in client.diagnostics


@pytest.mark.asyncio
async def test_outline_folding_and_formatting(client: LanguageClient) -> None:
    untidy = (
        MODEL.replace("  arm: {", "     arm: {", 1)
        .replace("[ground, arm]", "[ground,arm]")
        .replace("outputs:\n", "\n\n\noutputs:   \n")
    )
    editor = Editor(client, "outline.yaml", untidy)
    outline = await client.text_document_document_symbol_async(lsp.DocumentSymbolParams(editor.identifier))
    assert [own.name for own in outline] == re.findall(r"^(\w+):", MODEL, re.MULTILINE)
    bodies = next(own for own in outline if own.name == "bodies")
    assert [own.name for own in bodies.children] == ["arm"]
    assert [own.name for own in bodies.children[0].children] == ["hinge", "tip"]
    folds = await client.text_document_folding_range_async(lsp.FoldingRangeParams(editor.identifier))
    assert (1, 4) in [(own.start_line, own.end_line) for own in folds]
    options = lsp.FormattingOptions(tab_size=2, insert_spaces=True)
    edits = await client.text_document_formatting_async(lsp.DocumentFormattingParams(editor.identifier, options))
    assert applied(editor.uri, editor, edits) == MODEL.replace("outputs:\n", "\noutputs:\n")


@pytest.mark.asyncio
async def test_every_name_of_the_models_here_can_be_changed(client: LanguageClient) -> None:
    """The server refuses a name with which the model would have errors: only words of a repetition are."""
    folder = client.folder / "shipped"
    shutil.copytree(MODELS, folder, dirs_exist_ok=True)
    asked = 0
    for name in ["slider_crank", "four_bar_ventilator", "quarter_cars", "double_wishbone", "wiper", "computed_torque"]:
        text = (folder / f"{name}.yaml").read_text()
        editor = Editor(client, f"shipped/{name}.yaml", text)
        outline = await client.text_document_document_symbol_async(lsp.DocumentSymbolParams(editor.identifier))
        for section in outline:
            if section.name not in ("parameters", "bodies", "joints", "effects", "outputs", "instances", "scenes"):
                continue
            for own in section.children or []:
                if "{" in own.name or own.name == "ground" or "." in own.name:
                    continue
                params = lsp.RenameParams(editor.identifier, own.selection_range.start, f"{own.name}_new")
                try:
                    edit = await client.text_document_rename_async(params)
                except JsonRpcException as refused:
                    assert re.search(rf"repeat: {{ \w+: \[[^\]]*\b{own.name}\b", text), refused
                    continue
                assert edit.changes[editor.uri], own.name
                asked += 1
    assert asked > 60
