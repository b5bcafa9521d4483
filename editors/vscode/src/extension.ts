// Starts the language server, draws the mechanism, runs, and marks requirements with their verdicts.
import { promises as files } from "node:fs";
import * as os from "node:os";
import * as path from "node:path";
import * as vscode from "vscode";
import { LanguageClient } from "vscode-languageclient/node";
import { hasResults, isModel, linesOfRequirements, run, Verdict, verdicts } from "./program";

let client: LanguageClient | undefined;

/** How long the keyboard rests before a drawing is made anew, ms. */
const QUIET = 500;

const settings = () => vscode.workspace.getConfiguration("mbint");
const command = () => settings().get<string>("command") || "mbint";
const root = () => (settings().get<string>("root") ? ["--root", settings().get<string>("root") as string] : []);

export async function activate(context: vscode.ExtensionContext): Promise<void> {
    const adopt = (document: vscode.TextDocument) => {
        const head = document.getText(new vscode.Range(0, 0, 5, 0));
        if (document.languageId === "yaml" && isModel(head)) {
            void vscode.languages.setTextDocumentLanguage(document, "mbint");
        }
    };
    vscode.workspace.textDocuments.forEach(adopt);
    const drawings = new Drawings();
    const marks = new Marks();
    context.subscriptions.push(
        drawings,
        marks,
        vscode.workspace.onDidOpenTextDocument(adopt),
        vscode.workspace.onDidChangeTextDocument((change) => drawings.changed(change.document)),
        vscode.workspace.onDidChangeTextDocument((change) => marks.changed(change.document)),
        vscode.window.onDidChangeActiveTextEditor(() => marks.show()),
        vscode.commands.registerCommand("mbint.show", () => withModel((document) => drawings.open(document))),
        vscode.commands.registerCommand("mbint.run", () => withModel((document) => runModel(document, marks))),
        vscode.commands.registerCommand("mbint.report", () => withModel(openReport)),
    );
    client = new LanguageClient(
        "mbint",
        "mbint",
        { command: command(), args: ["lsp", ...root()] },
        { documentSelector: [{ language: "mbint" }] },
    );
    try {
        await client.start();
    } catch (error) {
        void vscode.window.showErrorMessage(`\`${command()} lsp\` cannot be started: ${String(error)}`);
    }
}

export function deactivate(): Promise<void> | undefined {
    return client?.stop();
}

async function withModel(then: (document: vscode.TextDocument) => Promise<void>): Promise<void> {
    const document = vscode.window.activeTextEditor?.document;
    if (!document || document.languageId !== "mbint") {
        void vscode.window.showInformationMessage("Open a model first.");
        return;
    }
    try {
        await then(document);
    } catch (error) {
        void vscode.window.showErrorMessage(`mbint: ${String(error)}`);
    }
}

const folderOf = (document: vscode.TextDocument) => path.dirname(document.fileName);
const resultsOf = (document: vscode.TextDocument) =>
    path.join(folderOf(document), "results", path.basename(document.fileName).replace(/(\.mbint)?\.ya?ml$/, ""));

/** Drawings beside their texts, drawn anew when the keyboard rests. */
class Drawings implements vscode.Disposable {
    private readonly panels = new Map<string, vscode.WebviewPanel>();
    private readonly waiting = new Map<string, NodeJS.Timeout>();

    async open(document: vscode.TextDocument): Promise<void> {
        const key = document.uri.toString();
        let panel = this.panels.get(key);
        if (!panel) {
            const title = path.basename(document.fileName);
            const beside = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
            panel = vscode.window.createWebviewPanel("mbint.drawing", title, beside, { enableScripts: false });
            panel.onDidDispose(() => this.panels.delete(key));
            this.panels.set(key, panel);
        }
        await this.draw(document, panel);
    }

    changed(document: vscode.TextDocument): void {
        const key = document.uri.toString();
        const panel = this.panels.get(key);
        if (!panel) return;
        clearTimeout(this.waiting.get(key));
        this.waiting.set(key, setTimeout(() => void this.redraw(document, panel), QUIET));
    }

    /** Where the program has gone meanwhile, the last drawing stays. */
    private redraw(document: vscode.TextDocument, panel: vscode.WebviewPanel): Promise<void> {
        return this.draw(document, panel).catch(() => undefined);
    }

    private async draw(document: vscode.TextDocument, panel: vscode.WebviewPanel): Promise<void> {
        const place = await files.mkdtemp(path.join(os.tmpdir(), "mbint-"));
        try {
            // From standard input: the text as it is, with its files in its folder.
            const args = ["show", "-", "-o", place, ...root()];
            const ended = await run(command(), args, folderOf(document), { input: document.getText() });
            // A text with errors keeps its last drawing; the errors stand in the text.
            if (ended.code === 0) panel.webview.html = page(await files.readFile(path.join(place, "mechanism.svg"), "utf8"));
            else if (!panel.webview.html) panel.webview.html = page("<p>The model has errors.</p>");
        } finally {
            await files.rm(place, { recursive: true, force: true });
        }
    }

    dispose(): void {
        this.waiting.forEach((timer) => clearTimeout(timer));
        this.panels.forEach((panel) => panel.dispose());
    }
}

/** A page that runs and loads nothing. */
const page = (content: string) =>
    `<!DOCTYPE html><html><head><meta http-equiv="Content-Security-Policy" content="default-src 'none'; ` +
    `style-src 'unsafe-inline'; img-src data:"><style>body{background:#fff;color:#000}svg{width:100%;height:auto}</style>` +
    `</head><body>${content.replace(/^<\?xml.*?\?>/, "")}</body></html>`;

/** Verdicts beside the requirements of texts that have been run. */
class Marks implements vscode.Disposable {
    private readonly found = new Map<string, Verdict[]>();
    private readonly kinds = {
        holds: mark("✔", "testing.iconPassed"),
        undecided: mark("?", "testing.iconQueued"),
        violated: mark("✘", "testing.iconFailed"),
    };

    set(document: vscode.TextDocument, found: Verdict[]): void {
        this.found.set(document.uri.toString(), found);
        this.show();
    }

    /** A text that has changed has no verdicts. */
    changed(document: vscode.TextDocument): void {
        if (this.found.delete(document.uri.toString())) this.show();
    }

    show(): void {
        for (const editor of vscode.window.visibleTextEditors) {
            const found = this.found.get(editor.document.uri.toString()) ?? [];
            const lines = linesOfRequirements(editor.document.getText());
            for (const [kind, decoration] of Object.entries(this.kinds)) {
                const here = found.filter((own) => own.verdict === kind && lines.has(own.name));
                editor.setDecorations(
                    decoration,
                    here.map((own) => {
                        const line = lines.get(own.name) as number;
                        const margin = `margin ${own.margin.toPrecision(3)} ± ${own.error.toPrecision(1)} ${own.unit}`;
                        const after = { contentText: `  ${own.verdict}, ${margin}`, color: colour("editorCodeLens.foreground") };
                        return { range: new vscode.Range(line, 0, line, 0), hoverMessage: own.text, renderOptions: { after } };
                    }),
                );
            }
        }
    }

    dispose(): void {
        Object.values(this.kinds).forEach((kind) => kind.dispose());
    }
}

const colour = (name: string) => new vscode.ThemeColor(name);

function mark(sign: string, name: string): vscode.TextEditorDecorationType {
    const picture =
        `<svg xmlns="http://www.w3.org/2000/svg" width="16" height="16"><text x="3" y="13" font-size="13" ` +
        `fill="${{ "✔": "#2e7d32", "?": "#b26a00", "✘": "#c62828" }[sign] ?? "#888"}">${sign}</text></svg>`;
    const gutterIconPath = vscode.Uri.parse(`data:image/svg+xml;base64,${Buffer.from(picture).toString("base64")}`);
    return vscode.window.createTextEditorDecorationType({
        gutterIconPath,
        gutterIconSize: "contain",
        overviewRulerColor: colour(name),
        isWholeLine: true,
    });
}

async function runModel(document: vscode.TextDocument, marks: Marks): Promise<void> {
    await document.save();
    const abort = new AbortController();
    const options = { location: vscode.ProgressLocation.Notification, title: `mbint: ${path.basename(document.fileName)}`, cancellable: true };
    const ended = await vscode.window.withProgress(options, (progress, token) => {
        token.onCancellationRequested(() => abort.abort());
        const args = ["run", document.fileName, "-o", resultsOf(document), "--format", "json", "--color", "never", ...root()];
        const said = (message: string) => progress.report({ message });
        return run(command(), args, folderOf(document), { aborted: abort.signal, said });
    });
    // A violated requirement has an exit code of its own, and results.
    if (!hasResults(ended.output)) throw new Error(ended.errors.trim() || `ended with code ${ended.code}`);
    marks.set(document, verdicts(ended.output));
    const answer = await vscode.window.showInformationMessage("The run has ended.", "Open the report");
    if (answer) await openReport(document);
}

async function openReport(document: vscode.TextDocument): Promise<void> {
    const report = path.join(resultsOf(document), "report.html");
    await files.access(report).catch(() => {
        throw new Error(`there is no ${report}: run the model first`);
    });
    await vscode.env.openExternal(vscode.Uri.file(report));
}
