// The extension with a mocked editor and the real program: MBINT names it.
const assert = require("node:assert/strict");
const fs = require("node:fs");
const Module = require("node:module");
const os = require("node:os");
const path = require("node:path");
const test = require("node:test");

const MBINT = process.env.MBINT ?? "mbint";
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "mbint-test-"));

const MODEL = `# yaml-language-server: $schema=../schemas/mbint.schema.json
model: ball
parameters: { g: 9.81 m/s^2 ± 1% }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { ball.y: 0, ball.vy: 0 }
outputs: { y: ball.y }
requirements:
  falls: y >= -0.2 m
  stays: y >= -0.01 m
simulation: { duration: 0.1, step: 1e-3, output_step: 0.01 }
`;

/** What the editor was told. */
const told = { commands: {}, panels: [], decorations: [], messages: [], progress: [], opened: [], clients: [], languages: [] };

function document(name, text) {
    const fileName = path.join(folder, name);
    fs.writeFileSync(fileName, text);
    return {
        fileName,
        languageId: "yaml",
        uri: { toString: () => `file://${fileName}` },
        getText: () => text,
        set: (new_text) => (text = new_text),
        save: async () => fs.writeFileSync(fileName, text),
    };
}

class Range {
    constructor(...places) {
        this.places = places;
    }
}

const listeners = { changed: [] };
const disposable = { dispose() {} };
const own = document("ball.yaml", MODEL);
const vscode = {
    Range,
    ThemeColor: class {},
    ViewColumn: { Beside: -2 },
    ProgressLocation: { Notification: 15 },
    Uri: { parse: (text) => ({ text }), file: (text) => ({ text }) },
    env: { openExternal: async (uri) => told.opened.push(uri.text) },
    languages: {
        setTextDocumentLanguage: async (changed, language) => {
            changed.languageId = language;
            told.languages.push(language);
        },
    },
    workspace: {
        textDocuments: [own],
        getConfiguration: () => ({ get: (key) => ({ command: MBINT, root: "" })[key] }),
        onDidOpenTextDocument: () => disposable,
        onDidChangeTextDocument: (listener) => (listeners.changed.push(listener), disposable),
    },
    window: {
        activeTextEditor: undefined,
        visibleTextEditors: [],
        onDidChangeActiveTextEditor: () => disposable,
        createTextEditorDecorationType: (options) => ({ ...disposable, options }),
        createWebviewPanel: () => {
            const panel = { webview: { html: "" }, onDidDispose: () => disposable, dispose() {} };
            told.panels.push(panel);
            return panel;
        },
        showErrorMessage: async (message) => void told.messages.push(message),
        showInformationMessage: async (message, answer) => (told.messages.push(message), answer),
        withProgress: (_, work) =>
            work({ report: (own) => told.progress.push(own.message) }, { onCancellationRequested: () => disposable }),
    },
    commands: { registerCommand: (name, run) => ((told.commands[name] = run), disposable) },
};

class LanguageClient {
    constructor(id, name, server, options) {
        told.clients.push({ server, options });
    }
    async start() {}
    async stop() {}
}

const load = Module._load;
Module._load = (request, ...rest) => {
    if (request === "vscode") return vscode;
    if (request === "vscode-languageclient/node") return { LanguageClient };
    return load(request, ...rest);
};
const { activate } = require("../out/extension.js");
const program = require("../out/program.js");

const editor = { document: own, setDecorations: (kind, marks) => told.decorations.push({ kind, marks }) };

test.before(async () => {
    vscode.window.activeTextEditor = editor;
    vscode.window.visibleTextEditors = [editor];
    await activate({ subscriptions: [] });
});

test("a model is known by its schema, and the server is started", () => {
    assert.deepEqual(told.languages, ["mbint"]);
    assert.deepEqual(told.clients[0].server, { command: MBINT, args: ["lsp"] });
    assert.deepEqual(told.clients[0].options.documentSelector, [{ language: "mbint" }]);
    assert.ok(!program.isModel("a: 1\n# no schema\n"));
});

test("the mechanism is drawn beside the text, and anew from a text that is not stored", async () => {
    await told.commands["mbint.show"]();
    assert.deepEqual(told.messages, []);
    const [panel] = told.panels;
    assert.match(panel.webview.html, /<svg/);
    assert.match(panel.webview.html, /default-src 'none'/);
    const before = panel.webview.html;
    own.set(MODEL.replace("ball: { mass: 1, coordinates: [y] }", "ball: { mass: 1, coordinates: [y], points: { top: [0, 1] } }"));
    listeners.changed.forEach((listener) => listener({ document: own }));
    for (let tries = 0; tries < 200 && panel.webview.html === before; tries++) await new Promise((then) => setTimeout(then, 50));
    assert.notEqual(panel.webview.html, before);
    assert.equal(fs.readFileSync(own.fileName, "utf8"), MODEL);
    own.set(MODEL);
});

test("a run marks requirements with their verdicts, and its report is opened", async () => {
    await told.commands["mbint.run"]();
    const marks = told.decorations.flatMap(({ marks }) => marks);
    const lines = Object.fromEntries(marks.map((mark) => [mark.range.places[0], mark.renderOptions.after.contentText]));
    // y = -g t²/2 is -0.049 m at the end: above -0.2 m, below -0.01 m.
    assert.match(lines[8], /^ {2}holds, margin 0\.15/);
    assert.match(lines[9], /^ {2}violated, margin -0\.039/);
    assert.equal(marks.length, 2);
    assert.deepEqual(told.opened, [path.join(folder, "results/ball/report.html")]);
    listeners.changed.forEach((listener) => listener({ document: own }));
    assert.ok(told.decorations.slice(-3).every(({ marks }) => marks.length === 0), "a text that has changed has no verdicts");
});

test("errors of a model are shown, and a program that is not there", async () => {
    own.set(MODEL.replace("ball.y }", "boll.y }"));
    await own.save();
    told.messages.length = 0;
    await told.commands["mbint.run"]();
    assert.match(told.messages[0], /boll/);
    await assert.rejects(program.run("/there/is/none", [], folder), /ENOENT/);
});

test("lines of requirements", () => {
    const lines = program.linesOfRequirements('a: 1\nrequirements:\n  # no\n  "x": y > 1\n  z: { max: 2 }\nb:\n  c: 1\n');
    assert.deepEqual([...lines], [["x", 3], ["z", 4]]);
    assert.deepEqual([...program.linesOfRequirements("requirements: { x: y > 1, z: y < 3 }")], [["x", 0], ["z", 0]]);
});

test.after(() => fs.rmSync(folder, { recursive: true, force: true }));
