// The scene's text: CodeMirror, with the program's own messages at the line.
import { defaultKeymap, history, historyKeymap, isolateHistory, redo, redoDepth, undo, undoDepth } from "@codemirror/commands";
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { lintGutter, setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { EditorSelection, EditorState, Transaction } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Complaint } from "./protocol";
import type { Change } from "./toml_edit";

/** Colours by what stands there, with enough contrast on both grounds. */
const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--quiet)", fontStyle: "italic" },
  { tag: tags.string, color: "var(--code-text)" },
  { tag: [tags.number, tags.bool, tags.atom], color: "var(--code-number)" },
  { tag: [tags.propertyName, tags.attributeName, tags.variableName], color: "var(--text)" },
  { tag: [tags.bracket, tags.heading], color: "var(--accent)", fontWeight: "600" },
]);

/** Joined into one step as typing is. */
const dragging = "input.type.drag";

export class Editor {
  readonly view: EditorView;

  constructor(place: HTMLElement, private readonly changed: (byHand: boolean) => void, private readonly moved: (line: number) => void) {
    this.view = new EditorView({ parent: place, state: this.fresh("") });
  }

  private fresh(text: string): EditorState {
    return EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(), highlightActiveLine(), highlightActiveLineGutter(), drawSelection(), lintGutter(),
        // A drag is one step, however many pictures it takes.
        history({ newGroupDelay: 2000, joinToEvent: (change, adjacent) => adjacent || change.isUserEvent(dragging) }),
        keymap.of([...defaultKeymap, ...historyKeymap]),
        StreamLanguage.define(toml), syntaxHighlighting(colours),
        EditorView.contentAttributes.of({ "aria-label": "Scene, as TOML", spellcheck: "false", tabindex: "0" }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) this.changed(!update.transactions.some((change) => change.isUserEvent(dragging)));
          if (update.selectionSet && update.view.hasFocus) this.moved(update.state.doc.lineAt(update.state.selection.main.head).number);
        }),
      ],
    });
  }

  get text(): string { return this.view.state.doc.toString(); }

  /** Another scene: nothing of this one can be undone into it. */
  open(text: string): void { this.view.setState(this.fresh(text)); }

  /** Changes the text as a step that can be undone; those of one drag are one. */
  change(changes: (Change | null)[], dragged = false): void {
    const wanted = changes.filter((change): change is Change => change !== null);
    if (wanted.length === 0) return;
    this.view.dispatch({ changes: wanted, annotations: Transaction.userEvent.of(dragged ? dragging : "input.panel") });
  }

  /** The next change begins a step of its own. */
  separate(): void { this.view.dispatch({ annotations: isolateHistory.of("full") }); }

  undo(): void { undo(this.view); }
  redo(): void { redo(this.view); }
  get canUndo(): boolean { return undoDepth(this.view.state) > 0; }
  get canRedo(): boolean { return redoDepth(this.view.state) > 0; }

  /** What is wrong, at its line; a message about the whole scene stands at the first. */
  mark(complaints: Complaint[]): void {
    const { doc } = this.view.state;
    const diagnostics = complaints.map((complaint): Diagnostic => {
      const line = doc.line(Math.min(Math.max(complaint.line, 1), doc.lines));
      const message = complaint.key === "" ? complaint.reason : `${complaint.key}: ${complaint.reason}`;
      return { from: line.from + /^\s*/.exec(line.text)![0].length, to: line.to, severity: "error", message };
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  /** Brings a line into sight. */
  show(line: number): void {
    const { doc } = this.view.state;
    if (line < 1 || line > doc.lines || this.view.hasFocus || doc.lineAt(this.view.state.selection.main.head).number === line) return;
    const at = doc.line(line).from;
    this.view.dispatch({ selection: EditorSelection.cursor(at), annotations: Transaction.addToHistory.of(false) });
    // Scrolls the text alone, not the page around it.
    const { scrollDOM } = this.view;
    scrollDOM.scrollTop = this.view.lineBlockAt(at).top - scrollDOM.clientHeight / 3;
  }
}
