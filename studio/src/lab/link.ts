// A link that carries the scene: its text and methods, packed behind the #.
import type { Chosen } from "./methods";

export interface Carried { scene: string; path: string; chosen: Chosen }

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const source = new Blob([bytes as BlobPart]).stream();
  return new Uint8Array(await new Response(source.pipeThrough(stream)).arrayBuffer());
}

export const unzip = (bytes: Uint8Array) => through(bytes, new DecompressionStream("gzip"));

export async function toHash(carried: Carried): Promise<string> {
  const packed = await through(new TextEncoder().encode(JSON.stringify(carried)), new CompressionStream("deflate-raw"));
  let text = "";
  for (const byte of packed) text += String.fromCharCode(byte);
  return `#scene=${btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

/** null: the link carries none. Throws where it is damaged. */
export async function fromHash(hash: string): Promise<Carried | null> {
  const packed = /^#scene=([A-Za-z0-9_-]+)$/.exec(hash);
  if (!packed) return null;
  const text = atob(packed[1].replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = await through(Uint8Array.from(text, (c) => c.charCodeAt(0)), new DecompressionStream("deflate-raw"));
  const carried = JSON.parse(new TextDecoder().decode(bytes)) as Partial<Carried>;
  const isValues = (values: unknown) => typeof values === "object" && values !== null && Object.values(values).every((value) => typeof value === "string");
  const { chosen } = carried;
  if (typeof carried.scene !== "string" || typeof carried.path !== "string" || !chosen || !isValues(chosen.a) || !isValues(chosen.b) || !isValues(chosen.shared)) {
    throw new Error("the link holds no scene");
  }
  return { scene: carried.scene, path: carried.path, chosen: { ...chosen, beside: Boolean(chosen.beside) } };
}
