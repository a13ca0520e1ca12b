// facet-viewer.d.ts - types of <facet-viewer>. Names and meanings are those of <model-viewer> 4.4; what is facet's own says so.

export interface Vector3D {
  x: number;
  y: number;
  z: number;
  toString(): string;
}

export interface SphericalPosition {
  /** Around +Y, in radians; 0 is in front. */
  theta: number;
  /** From straight above, in radians. */
  phi: number;
  /** In meters. */
  radius: number;
  toString(): string;
}

export interface HotspotConfiguration {
  name: string;
  position?: string;
  normal?: string;
  surface?: string;
}

export interface HotspotData {
  position: Vector3D;
  normal: Vector3D;
  canvasPosition: Vector3D;
  facingCamera: boolean;
}

export interface PlayAnimationOptions {
  repetitions?: number;
  pingpong?: boolean;
}

export interface ToBlobOptions {
  mimeType?: string;
  qualityArgument?: number;
  idealAspect?: boolean;
}

/** facet's own. */
export interface ScreenshotOptions {
  /** In pixels; without a size, that of the element. */
  width?: number;
  height?: number;
  /** A media type; "image/png" where it is missing. */
  type?: string;
  quality?: number;
}

/** A file by its path relative to the folder that was opened. */
export interface ModelFile {
  path: string;
  file: Blob;
}

export interface PickedPoint {
  position: [number, number, number];
  normal: [number, number, number];
  /** Its index in the file; -1: the default material. */
  material: number;
}

/** facet's own: what is shown, and how. Angles in degrees, lengths in meters, times in seconds. */
export interface ViewerState {
  /** The last warning, or what the last change means; "": nothing. */
  message: string;
  /** The path of the model; "": the built-in scene; null: there is none yet. */
  model: string | null;
  bounds?: { min: [number, number, number]; max: [number, number, number] };
  size?: [number, number, number];
  /** Names, in the order of the file. */
  animations?: string[];
  variants?: string[];
  cameras?: string[];
  scenes?: string[];
  /** When each animation begins and ends. */
  animationTimes?: [number, number][];
  orbit: {
    azimuth: number | null; polar: number | null; radius: number | null; target: [number, number, number]; fov: number | null;
    isOrthographic: boolean; isFramed: boolean;
  };
  isPlaying: boolean;
  time: number;
  begin: number;
  end: number;
  speed: number;
  /** Indices; null: none is chosen. */
  animation: number | null;
  variant: number | null;
  camera: number | null;
  comparison: { name: string; position: number; left: string; right: string };
  stats: RenderInfo;
}

/** facet's own: the last frame. */
export interface RenderInfo {
  triangles?: number;
  draws?: number;
  vertices?: number;
  /** Of the processor, in all and by its parts. */
  seconds?: number;
  geometrySeconds?: number;
  lightSeconds?: number;
  textureSeconds?: number;
  drawSeconds?: number;
}

export type ChangeSource = 'user-interaction' | 'automatic' | 'none';
export type ToneMapping = 'auto' | 'neutral' | 'commerce' | 'aces' | 'agx' | 'reinhard' | 'cineon' | 'linear' | 'none';

export interface FacetViewerEventMap {
  load: CustomEvent<{ url: string | null }>;
  error: CustomEvent<{ type: 'loadfailure' | 'webglcontextlost'; message: string; sourceError: Error }>;
  progress: CustomEvent<{ totalProgress: number; reason: string }>;
  'model-visibility': CustomEvent<{ visible: boolean }>;
  'poster-dismissed': CustomEvent<undefined>;
  'camera-change': CustomEvent<{ source: ChangeSource }>;
  'environment-change': CustomEvent<undefined>;
  'variant-applied': CustomEvent<undefined>;
  play: CustomEvent<undefined>;
  pause: CustomEvent<undefined>;
  loop: CustomEvent<{ count: number; name: string }>;
  finished: CustomEvent<undefined>;
  'render-scale': CustomEvent<{
    reportedDpr: number; renderedDpr: number; minimumDpr: number; pixelWidth: number; pixelHeight: number; reason: string;
  }>;
  'before-render': CustomEvent<undefined>;
  /** facet's own: options, pose or materials were changed by a script. */
  'facet-change': CustomEvent<undefined>;
  /** facet's own: a warning of the reader, or what a change means. */
  'facet-message': CustomEvent<{ text: string }>;
}

export class FacetViewer extends HTMLElement {
  /** How many fetched files are kept for elements that show the same. */
  static modelCacheSize: number;
  /** The lowest resolution while the camera moves, in (0, 1]; at rest it is always 1. */
  static minimumRenderScale: number;
  static mapURLs(callback: (url: string) => string): void;

  // what is shown
  src: string | null;
  alt: string | null;
  poster: string | null;
  loading: 'auto' | 'lazy' | 'eager';
  reveal: 'auto' | 'manual';
  withCredentials: boolean;
  readonly loaded: boolean;
  readonly modelIsVisible: boolean;
  readonly updateComplete: Promise<boolean>;
  dismissPoster(): void;
  showPoster(): void;
  getDimensions(): Vector3D;
  getBoundingBoxCenter(): Vector3D;

  // the camera
  cameraControls: boolean;
  cameraOrbit: string;
  cameraTarget: string;
  fieldOfView: string;
  minCameraOrbit: string;
  maxCameraOrbit: string;
  minFieldOfView: string;
  maxFieldOfView: string;
  orbitSensitivity: number;
  zoomSensitivity: number;
  panSensitivity: number;
  inputSensitivity: number;
  interpolationDecay: number;
  touchAction: 'none' | 'pan-x' | 'pan-y';
  disableZoom: boolean;
  disablePan: boolean;
  disableTap: boolean;
  interactionPrompt: 'auto' | 'none';
  interactionPromptStyle: 'wiggle' | 'basic';
  interactionPromptThreshold: number;
  autoRotate: boolean;
  autoRotateDelay: number;
  rotationPerSecond: string;
  a11y: string | Record<string, string> | null;
  readonly turntableRotation: number;
  getCameraOrbit(): SphericalPosition;
  getCameraTarget(): Vector3D;
  getFieldOfView(): number;
  getMinimumFieldOfView(): number;
  getMaximumFieldOfView(): number;
  getIdealAspect(): number;
  jumpCameraToGoal(): void;
  updateFraming(): Promise<void>;
  resetTurntableRotation(theta?: number): void;
  resetInteractionPrompt(): void;
  zoom(keyPresses: number): void;

  // light
  environmentImage: string | null;
  skyboxImage: string | null;
  skyboxHeight: string;
  exposure: number;
  toneMapping: ToneMapping | string;
  shadowIntensity: number;
  shadowSoftness: number;

  // the model
  autoplay: boolean;
  animationName: string | null;
  animationCrossfadeDuration: number;
  variantName: string | null;
  orientation: string;
  scale: string;
  readonly availableAnimations: string[];
  readonly availableVariants: string[];
  readonly paused: boolean;
  readonly duration: number;
  currentTime: number;
  timeScale: number;
  play(options?: PlayAnimationOptions): void;
  pause(): void;

  // points
  positionAndNormalFromPoint(clientX: number, clientY: number): { position: Vector3D; normal: Vector3D; uv: null } | null;
  surfaceFromPoint(clientX: number, clientY: number): string | null;
  updateHotspot(config: HotspotConfiguration): void;
  queryHotspot(name: string): HotspotData | null;

  // images and files
  toDataURL(type?: string, encoderOptions?: number): string;
  toBlob(options?: ToBlobOptions): Promise<Blob>;
  exportScene(): Promise<Blob>;

  // augmented reality: there is none; its settings are accepted, without effect, as is generateSchema
  ar: boolean;
  arModes: string;
  arScale: string;
  arPlacement: string;
  arUsdzMaxTextureSize: string;
  iosSrc: string | null;
  xrEnvironment: boolean;
  generateSchema: boolean;
  readonly canActivateAR: false;
  activateAR(): Promise<void>;

  // facet's own
  /** 'tight': an unmoved camera shows the whole model as facet render does, from its direction; 'sphere' (default): so that it stays in view
   * from every direction. */
  facetFraming: 'sphere' | 'tight';
  facetChannel: string | null;
  facetBrdf: string | null;
  facetTransparency: string | null;
  /** Shows the first model of the files, or lights with the one image; resolves to the paths of all models. */
  openFiles(files: ModelFile[]): Promise<string[]>;
  /** One of the opened files, or "" for the built-in scene. */
  openModel(path: string): Promise<void>;
  readonly files: ModelFile[];
  readonly modelPath: string | null;
  /**
   * An option of `facet render` by its long name; null: its default. Also "compare" (masking, scattering, tone-mapping, variant) and
   * "divider" (0 to 1): two images side by side.
   */
  setOption(name: string, text: string | null): Promise<void>;
  /** All options that differ from their defaults. Setting them gives the same image. */
  readonly options: Record<string, string>;
  /** The command line that renders this image. */
  command(width?: number, height?: number): string;
  /** What `facet inspect --json` says of the model. */
  describe(): Record<string, unknown>;
  /** Without a model only a part of it is there. */
  readonly state: Partial<ViewerState>;
  readonly renderInfo: RenderInfo;
  /** values: a part of a glTF material. */
  setMaterial(index: number, values: Record<string, unknown>): void;
  readonly materials: Record<string, unknown>[];
  imageBlob(index: number): Promise<Blob | null>;
  screenshot(options?: ScreenshotOptions): Promise<Blob>;
  /** x, y: pixels of the element. */
  pick(x: number, y: number): PickedPoint | null;

  addEventListener<K extends keyof FacetViewerEventMap>(
    type: K, listener: (this: FacetViewer, event: FacetViewerEventMap[K]) => unknown, options?: boolean | AddEventListenerOptions): void;
  addEventListener<K extends keyof HTMLElementEventMap>(
    type: K, listener: (this: FacetViewer, event: HTMLElementEventMap[K]) => unknown, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    'facet-viewer': FacetViewer;
  }
}
