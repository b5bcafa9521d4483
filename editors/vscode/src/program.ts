// The mbint program: how it is called, and what it prints.
import { spawn } from "node:child_process";

export interface Ended {
    code: number | null;
    output: string;
    errors: string;
}

/** Runs the program in a folder until it ends; `aborted` ends it, `said` hears lines of standard error. */
export function run(
    command: string,
    args: string[],
    folder: string,
    options: { input?: string; aborted?: AbortSignal; said?: (line: string) => void } = {},
): Promise<Ended> {
    return new Promise((resolve, reject) => {
        const process = spawn(command, args, { cwd: folder, signal: options.aborted });
        let output = "";
        let errors = "";
        process.on("error", reject);
        process.stdout.setEncoding("utf8").on("data", (text: string) => (output += text));
        process.stderr.setEncoding("utf8").on("data", (text: string) => {
            errors += text;
            const lines = text.split(/[\r\n]+/).filter((line) => line.trim());
            if (lines.length) options.said?.(lines[lines.length - 1].trim());
        });
        process.on("close", (code) => resolve({ code, output, errors }));
        // A program that ends before it has read everything is no fault of ours.
        process.stdin.on("error", () => undefined);
        process.stdin.end(options.input ?? "");
    });
}

export interface Verdict {
    name: string;
    text: string;
    verdict: "holds" | "undecided" | "violated";
    margin: number;
    error: number;
    unit: string;
}

/** Whether a run's JSON has results, and not errors alone. */
export function hasResults(json: string): boolean {
    return json.trim() !== "" && (JSON.parse(json) as { summary?: unknown }[]).some((result) => result.summary);
}

/** Verdicts of a run's JSON, of scenes the worst of each requirement. */
export function verdicts(json: string): Verdict[] {
    const order = ["holds", "undecided", "violated"];
    const worst = new Map<string, Verdict>();
    for (const result of JSON.parse(json) as { summary?: { requirements?: Verdict[] } }[]) {
        for (const own of result.summary?.requirements ?? []) {
            const known = worst.get(own.name);
            if (!known || order.indexOf(own.verdict) > order.indexOf(known.verdict)) worst.set(own.name, own);
        }
    }
    return [...worst.values()];
}

/** The line of each requirement of a text: keys below `requirements:`. */
export function linesOfRequirements(text: string): Map<string, number> {
    const found = new Map<string, number>();
    let within = false;
    text.split("\n").forEach((line, number) => {
        if (/^\S/.test(line) && !line.startsWith("#")) {
            within = /^requirements\s*:/.test(line);
            // `requirements: { low: … }` on one line.
            for (const key of within ? line.matchAll(/[{,]\s*(\w+)\s*:/g) : []) found.set(key[1], number);
        } else if (within) {
            const key = /^\s+"?(\w+)"?\s*:/.exec(line);
            if (key && !found.has(key[1])) found.set(key[1], number);
        }
    });
    return found;
}

/** Whether a text is a model by its first lines. */
export function isModel(head: string): boolean {
    return /^#.*mbint\.schema\.json/m.test(head);
}
