// Pictures and films of the views, with what they show written into them.

export interface Caption { x: number; y: number; text: string }

/** The views and their captions on a canvas of their own. */
export function compose(source: HTMLCanvasElement, captions: Caption[], colour: string, into: HTMLCanvasElement): void {
  if (into.width !== source.width || into.height !== source.height) {
    into.width = source.width;
    into.height = source.height;
  }
  const context = into.getContext("2d")!;
  const scale = source.width / Math.max(1, source.clientWidth);
  context.drawImage(source, 0, 0);
  context.fillStyle = colour;
  context.font = `${13 * scale}px system-ui, sans-serif`;
  context.textBaseline = "top";
  for (const { x, y, text } of captions) context.fillText(text, x * scale, y * scale);
}

export function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

const filmTypes = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

/** The kind of film that this browser makes; "" if it makes none. */
export function filmType(): string {
  if (typeof MediaRecorder === "undefined" || !("captureStream" in HTMLCanvasElement.prototype)) return "";
  return filmTypes.find((type) => MediaRecorder.isTypeSupported(type)) ?? "";
}

/** Records a canvas until it is stopped. */
export class Film {
  private readonly parts: Blob[] = [];
  private readonly recorder: MediaRecorder;
  private readonly began = performance.now();

  constructor(readonly canvas: HTMLCanvasElement) {
    this.recorder = new MediaRecorder(canvas.captureStream(60), { mimeType: filmType(), videoBitsPerSecond: 12_000_000 });
    this.recorder.ondataavailable = (part) => this.parts.push(part.data);
    this.recorder.start(500);
  }

  /** The film, of half a second at least, and until a picture has come out of the encoder: it gives nothing of a moment, and
   *  takes its time on a busy machine. */
  async stop(): Promise<Blob> {
    const header = 500; // bytes
    const waits = () => performance.now() - this.began < (this.parts.some((part) => part.size > header) ? 500 : 10_000);
    while (waits()) {
      await new Promise((next) => requestAnimationFrame(next));
      const context = this.canvas.getContext("2d")!;
      context.drawImage(this.canvas, 0, 0, 1, 1, 0, 0, 1, 1); // a picture counts where something is drawn
    }
    return new Promise((done) => {
      this.recorder.onstop = () => done(new Blob(this.parts, { type: this.recorder.mimeType }));
      this.recorder.stop();
      this.recorder.stream.getTracks().forEach((track) => track.stop());
    });
  }
}
